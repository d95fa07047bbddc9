#include "tests/support/formats/schematic_bytes.hpp"

#include <zlib.h>

#include "common/core/assert.hpp"

namespace runstone::test {

NbtBytes& NbtBytes::big(std::int64_t v, int bytes) {
  for (int i = bytes - 1; i >= 0; --i)
    out_.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(v) >> (8 * i)));
  return *this;
}

NbtBytes& NbtBytes::raw(const Bytes& v) {
  out_.insert(out_.end(), v.begin(), v.end());
  return *this;
}

NbtBytes& NbtBytes::chars(std::string_view text) {
  big(static_cast<std::int64_t>(text.size()), 2);
  out_.insert(out_.end(), text.begin(), text.end());
  return *this;
}

NbtBytes& NbtBytes::head(std::uint8_t type, std::string_view name) {
  out_.push_back(type);
  return chars(name);
}

NbtBytes& NbtBytes::bytes(std::string_view name, const Bytes& v) {
  return head(7, name).big(static_cast<std::int64_t>(v.size()), 4).raw(v);
}

NbtBytes& NbtBytes::ints(std::string_view name, const std::vector<std::int32_t>& v) {
  head(11, name).big(static_cast<std::int64_t>(v.size()), 4);
  for (const std::int32_t i : v) big(i, 4);
  return *this;
}

NbtBytes& NbtBytes::longs(std::string_view name, const std::vector<std::uint64_t>& v) {
  head(12, name).big(static_cast<std::int64_t>(v.size()), 4);
  for (const std::uint64_t i : v) big(static_cast<std::int64_t>(i), 8);
  return *this;
}

NbtBytes& NbtBytes::list(std::string_view name, std::uint8_t type, std::int64_t count) {
  return head(9, name).raw({type}).big(count, 4);
}

Bytes gzip_of(const Bytes& plain) {
  z_stream stream{};
  const int begun = deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  RUNSTONE_ASSERT(begun == Z_OK);
  Bytes out(deflateBound(&stream, static_cast<uLong>(plain.size())) + 64);
  stream.next_in = const_cast<Bytef*>(plain.data());
  stream.avail_in = static_cast<uInt>(plain.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  const int ended = deflate(&stream, Z_FINISH);
  RUNSTONE_ASSERT(ended == Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

Bytes sponge_plain(const SpongeFields& fields) {
  NbtBytes out;
  const bool is_nested = fields.version == 3;
  if (is_nested)
    out.open("").open("Schematic");
  else
    out.open("Schematic");
  out.i32("Version", fields.version).i32("DataVersion", 2975);
  out.open("Metadata").text("Name", fields.name).text("Author", fields.author);
  out.i64("Date", fields.date);
  if (!fields.origin.empty()) out.open("WorldEdit").ints("Origin", fields.origin).close();
  out.close();
  out.i16("Width", fields.sides.x).i16("Height", fields.sides.y).i16("Length", fields.sides.z);
  out.ints("Offset", fields.offset);
  Bytes data;
  for (std::uint32_t number : fields.cells) {
    for (; number >= 128; number >>= 7) data.push_back(static_cast<std::uint8_t>(number | 128));
    data.push_back(static_cast<std::uint8_t>(number));
  }
  if (is_nested) out.open("Blocks");
  const char* data_name = is_nested ? "Data" : "BlockData";
  if (fields.has_data_first) out.bytes(data_name, data);
  out.open("Palette");
  for (const auto& [name, number] : fields.palette) out.i32(name, number);
  out.close();
  if (!fields.has_data_first) out.bytes(data_name, data);
  out.list("BlockEntities", 10, 1).text("Id", "minecraft:chest").close();
  if (is_nested) out.close().close();
  return out.close().get();
}

Bytes mcedit_plain(const MceditFields& fields) {
  NbtBytes out;
  out.open("Schematic").text("Materials", fields.materials);
  out.i16("Width", fields.sides.x).i16("Height", fields.sides.y).i16("Length", fields.sides.z);
  out.bytes("Blocks", fields.blocks).bytes("Data", fields.data);
  if (!fields.add.empty()) out.bytes("AddBlocks", fields.add);
  if (!fields.mapping.empty()) {
    out.open("SchematicaMapping");
    for (const auto& [name, id] : fields.mapping) out.i16(name, id);
    out.close();
  }
  out.i32("WEOriginX", 100).i32("WEOriginY", -7).i32("WEOriginZ", 3);
  out.list("TileEntities", 10, 0).list("Entities", 10, 0);
  return out.close().get();
}

Bytes litematic_plain(const std::vector<LitematicRegionFields>& regions, int version) {
  NbtBytes out;
  const auto place = [&](const char* name, VoxelPos at) {
    out.open(name).i32("x", at.x).i32("y", at.y).i32("z", at.z).close();
  };
  out.open("").open("Regions");
  for (const LitematicRegionFields& region : regions) {
    out.open(region.name).longs("BlockStates", region.longs);
    place("Position", region.position);
    place("Size", region.size);
    out.list("TileEntities", 10, 1).text("id", "minecraft:chest").close();
    out.list("BlockStatePalette", 10, static_cast<std::int64_t>(region.palette.size()));
    for (const auto& state : region.palette) {
      out.text("Name", state.name);
      if (!state.properties.empty()) {
        out.open("Properties");
        for (const auto& [key, value] : state.properties) out.text(key, value);
        out.close();
      }
      out.close();
    }
    out.list("Entities", 0, 0).close();
  }
  out.close().i32("Version", version).i32("MinecraftDataVersion", 2975);
  out.open("Metadata").text("Name", "house").text("Author", "me").i64("TimeCreated", 1234).close();
  return out.close().get();
}

std::vector<std::uint64_t> packed_longs(const std::vector<std::uint32_t>& numbers, unsigned bits) {
  std::vector<std::uint64_t> out((numbers.size() * bits + 63) / 64);
  for (std::size_t i = 0; i < numbers.size() * bits; ++i) {
    const std::uint64_t bit = numbers[i / bits] >> (i % bits) & 1u;
    out[i / 64] |= bit << (i % 64);
  }
  return out;
}

}  // namespace runstone::test
