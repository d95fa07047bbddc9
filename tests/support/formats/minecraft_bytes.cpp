#include "tests/support/formats/minecraft_bytes.hpp"

#include <lz4.h>
#include <xxhash.h>

#include <algorithm>
#include <bit>

#include "common/formats/deflate.hpp"
#include "common/formats/nbt_writer.hpp"

namespace runstone::test {
namespace {

constexpr std::size_t kSector = 4096;

void put_big_endian(Bytes& out, std::uint64_t v, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) out.push_back(static_cast<std::uint8_t>(v >> (8 * i)));
}

/// Packs bit by bit, which is slow and plain.
std::vector<std::uint64_t> packed(const std::vector<std::uint16_t>& values, unsigned bits,
                                  bool crossing) {
  const unsigned per_long = 64 / bits;
  const std::size_t count =
      crossing ? (values.size() * bits + 63) / 64 : (values.size() + per_long - 1) / per_long;
  std::vector<std::uint64_t> out(count);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t first = crossing ? i * bits : i / per_long * 64 + i % per_long * bits;
    for (unsigned bit = 0; bit < bits; ++bit) {
      if (values[i] >> bit & 1) out[(first + bit) / 64] |= std::uint64_t{1} << ((first + bit) % 64);
    }
  }
  return out;
}

void write_palette(NbtWriter& out, const char* name, const std::vector<ForeignBlock>& palette) {
  out.list(name, NbtType::compound, static_cast<std::int32_t>(palette.size()));
  for (const ForeignBlock& block : palette) {
    out.string("Name", block.name);
    if (!block.states.empty()) {
      out.compound("Properties");
      std::string rest = block.states;
      while (!rest.empty()) {
        const std::size_t end = std::min(rest.find(','), rest.size());
        const std::size_t equals = rest.find('=');
        out.string(rest.substr(0, equals), rest.substr(equals + 1, end - equals - 1));
        rest.erase(0, end + 1);
      }
      out.end();
    }
    out.end();
  }
}

void write_longs(NbtWriter& out, Bytes& bytes, const char* name, const McSection& section,
                 bool crossing) {
  const unsigned bits =
      section.bits != 0
          ? section.bits
          : std::max(4U, static_cast<unsigned>(std::bit_width(section.palette.size() - 1)));
  auto longs = packed(section.indices, bits, crossing);
  if (section.longs) longs.resize(*section.longs);
  out.array(name, NbtType::long_array, static_cast<std::int32_t>(longs.size()));
  for (const std::uint64_t v : longs) put_big_endian(bytes, v, 8);
}

void write_numbers(NbtWriter& out, Bytes& bytes, const McSection& section) {
  const auto& numbers = section.indices;
  out.array("Blocks", NbtType::byte_array, static_cast<std::int32_t>(numbers.size()));
  for (const auto number : numbers) bytes.push_back(static_cast<std::uint8_t>(number >> 4));
  const auto nibbles = [&](const char* name, int shift) {
    out.array(name, NbtType::byte_array, static_cast<std::int32_t>(numbers.size() / 2));
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
      bytes.push_back(static_cast<std::uint8_t>((numbers[i] >> shift & 15) |
                                                (numbers[i + 1] >> shift & 15) << 4));
    }
  };
  nibbles("Data", 0);
  if (std::any_of(numbers.begin(), numbers.end(), [](auto n) { return n >> 12 != 0; }))
    nibbles("Add", 12);
}

void write_section(NbtWriter& out, Bytes& bytes, const McSection& section, ChunkLayout layout) {
  if (section.y) out.i8("Y", *section.y);
  if (layout == ChunkLayout::numbers) {
    if (!section.indices.empty()) write_numbers(out, bytes, section);
  } else if (layout == ChunkLayout::tall) {
    out.compound("block_states");
    if (!section.indices.empty()) write_longs(out, bytes, "data", section, false);
    write_palette(out, "palette", section.palette);
    out.end();
  } else if (!section.palette.empty()) {
    write_palette(out, "Palette", section.palette);
    if (!section.indices.empty())
      write_longs(out, bytes, "BlockStates", section, layout == ChunkLayout::crossed);
  }
  out.array("SkyLight", NbtType::byte_array, 4);
  bytes.insert(bytes.end(), 4, 255);
  out.end();
}

}  // namespace

Bytes mc_chunk(const McChunk& chunk) {
  constexpr std::int32_t kVersions[] = {1343, 1976, 2586, 2865};
  Bytes bytes;
  NbtWriter out(bytes);
  out.compound("");
  const auto version = [&] {
    out.i32("DataVersion", chunk.version.value_or(kVersions[static_cast<int>(chunk.layout)]));
  };
  if (!chunk.version_last) version();
  const bool is_tall = chunk.layout == ChunkLayout::tall;
  if (!is_tall) out.compound("Level");
  out.list(is_tall ? "sections" : "Sections", NbtType::compound,
           static_cast<std::int32_t>(chunk.sections.size()));
  for (const McSection& section : chunk.sections) write_section(out, bytes, section, chunk.layout);
  if (chunk.x) out.i32("xPos", *chunk.x);
  if (chunk.z) out.i32("zPos", *chunk.z);
  out.string("Status", chunk.status);
  if (!is_tall) out.end();
  if (chunk.version_last) version();
  out.end();
  return bytes;
}

Bytes lz4_java_stream(const Bytes& plain, std::size_t block_bytes) {
  Bytes out;
  const auto head = [&](std::uint8_t token, std::size_t packed_bytes, std::size_t plain_bytes,
                        std::uint32_t checksum) {
    for (const char c : std::string("LZ4Block")) out.push_back(static_cast<std::uint8_t>(c));
    ByteWriter w(out);
    w.u8(token);
    w.u32(static_cast<std::uint32_t>(packed_bytes));
    w.u32(static_cast<std::uint32_t>(plain_bytes));
    w.u32(checksum);
  };
  const auto level = static_cast<std::uint8_t>(
      std::max(0, static_cast<int>(std::bit_width(block_bytes - 1)) - 10));
  for (std::size_t at = 0; at < plain.size(); at += block_bytes) {
    const std::size_t count = std::min(block_bytes, plain.size() - at);
    Bytes packed(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(count))));
    packed.resize(static_cast<std::size_t>(LZ4_compress_default(
        reinterpret_cast<const char*>(plain.data() + at), reinterpret_cast<char*>(packed.data()),
        static_cast<int>(count), static_cast<int>(packed.size()))));
    const std::uint32_t checksum = XXH32(plain.data() + at, count, 0x9747b28c) & 0x0fffffff;
    const bool is_stored = packed.size() >= count;
    head(static_cast<std::uint8_t>((is_stored ? 0x10 : 0x20) | level),
         is_stored ? count : packed.size(), count, checksum);
    if (is_stored)
      out.insert(out.end(), plain.data() + at, plain.data() + at + count);
    else
      out.insert(out.end(), packed.begin(), packed.end());
  }
  head(static_cast<std::uint8_t>(0x10 | level), 0, 0, 0);
  return out;
}

McSlot mc_slot(unsigned slot, const Bytes& plain, std::uint8_t compression) {
  McSlot out{slot, compression, plain};
  if (compression == 1) out.packed = deflate_all(plain, DeflateForm::gzip);
  if (compression == 2) out.packed = deflate_all(plain, DeflateForm::zlib);
  if (compression == 4) out.packed = lz4_java_stream(plain);
  return out;
}

Bytes mc_region(const std::vector<McSlot>& slots) {
  Bytes out(2 * kSector);
  for (const McSlot& slot : slots) {
    const std::size_t sector = out.size() / kSector;
    put_big_endian(out, slot.packed.size() + 1, 4);
    out.push_back(slot.compression);
    out.insert(out.end(), slot.packed.begin(), slot.packed.end());
    out.resize((out.size() + kSector - 1) / kSector * kSector);
    set_place(out, slot.slot, static_cast<std::uint32_t>(sector),
              static_cast<std::uint8_t>(out.size() / kSector - sector));
  }
  return out;
}

void set_place(Bytes& region, unsigned slot, std::uint32_t sector, std::uint8_t count) {
  Bytes place;
  put_big_endian(place, sector << 8 | count, 4);
  std::copy(place.begin(), place.end(), region.begin() + slot * 4);
}

}  // namespace runstone::test
