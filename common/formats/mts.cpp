#include "common/formats/mts.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/formats/deflate.hpp"
#include "common/formats/grid_cells.hpp"
#include "common/formats/grid_pieces.hpp"
#include "common/formats/inflate_source.hpp"
#include "common/formats/luanti_names.hpp"
#include "common/shapes/shape_states.hpp"

namespace runstone {
namespace {

constexpr std::size_t kMtsPart = 8192;  // nodes
constexpr int kMtsLevel = 6;

std::uint16_t mts_u16(ByteReader& in) {
  const unsigned high = in.u8();
  return static_cast<std::uint16_t>(high << 8 | in.u8());
}

/// Returns a name and its states, apart.
ForeignBlock mts_block(std::string_view name) {
  const std::size_t open = name.rfind('[');
  if (!name.ends_with(']') || open == std::string_view::npos) return {std::string(name), ""};
  return {std::string(name.substr(0, open)),
          std::string(name.substr(open + 1, name.size() - open - 2))};
}

struct MtsHead {
  std::uint16_t version = 0;
  VoxelPos sides;
  std::vector<bool> is_layer_placed;  // by y
  std::vector<ForeignBlock> names;    // by node id
  std::size_t nodes_at = 0;           // offset of the zlib stream
};

Result<MtsHead> read_mts_head(ByteView file) {
  ByteReader in(file);
  MtsHead out;
  const ByteView mark = in.bytes(4);
  if (in.ok() && std::string_view(reinterpret_cast<const char*>(mark.data()), 4) != "MTSM")
    return fail(ErrorCode::bad_value, "mts: is not a schematic of Luanti", 0);
  out.version = mts_u16(in);
  if (in.ok() && (out.version < 1 || out.version > 4))
    return fail(ErrorCode::bad_version, "mts: of another version than 1 to 4", 4);
  for (std::int32_t* side : {&out.sides.x, &out.sides.y, &out.sides.z}) {
    *side = mts_u16(in);
    if (in.ok() && *side == 0) return fail(ErrorCode::bad_value, "mts: a side is 0", 6);
  }
  for (std::int32_t y = 0; y < out.sides.y && in.ok(); ++y) {
    // Version 4 has flags in the highest bit.
    const unsigned chance = out.version >= 3 ? in.u8() : 255U;
    out.is_layer_placed.push_back((out.version >= 4 ? chance & 127U : chance) != 0);
  }
  const std::uint16_t count = mts_u16(in);
  for (std::uint16_t i = 0; i < count && in.ok(); ++i) {
    const ByteView name = in.bytes(mts_u16(in));
    out.names.push_back(mts_block({reinterpret_cast<const char*>(name.data()), name.size()}));
  }
  if (!in.ok()) return fail(ErrorCode::truncated, "mts: file ends in its head", in.error().offset);
  out.nodes_at = in.offset();
  return out;
}

/// Finds the blocks of nodes.
class MtsBlocks {
 public:
  explicit MtsBlocks(const MtsHead& head) : head_(head) {}

  const std::vector<ForeignBlock>& blocks() const { return blocks_; }
  /// Returns the index of a block + 1, or 0 for "ignore"; nullopt if there are too many. Requires a known
  /// id.
  std::optional<Material> material(std::uint16_t id, std::uint8_t param2) {
    const ForeignBlock& name = head_.names[id];
    if (name.name == "ignore") return Material{0};
    const auto [known, is_new] = materials_.try_emplace({id, param2}, Material{0});
    if (!is_new) return known->second;
    bytes_ += name.name.size() + name.states.size();
    if (blocks_.size() == kMaterialCountMax - 1 || bytes_ > kMtsNameBytesMax) return std::nullopt;
    blocks_.push_back(name);
    if (param2 != 0) {
      std::string& states = blocks_.back().states;
      states += (states.empty() ? "" : ",") + std::string(kLuantiParam) + std::to_string(param2);
    }
    known->second = static_cast<Material>(blocks_.size());
    return known->second;
  }

 private:
  const MtsHead& head_;
  std::vector<ForeignBlock> blocks_;
  std::map<std::pair<std::uint16_t, std::uint8_t>, Material> materials_;
  std::size_t bytes_ = 0;  // of the names of the blocks
};

/// Returns a name of a material as the name of a node. Names that a reader of nodes would change,
/// or take for a written name, are written so that they can be read back.
std::string mts_name(const std::string& name) {
  const bool is_plain =
      std::all_of(name.begin(), name.end(), [](char c) { return c > 0x20 && c < 0x7f; });
  return is_plain && !material_of_luanti_name(name) && name != "ignore" ? name
                                                                        : luanti_node_name(name);
}

LuantiNode mts_node(const BuildMaterial& material) {
  if (material.row.visibility == Visibility::empty) return {"air"};
  const std::string& name = material.row.name;
  std::string_view states = material.states;
  LuantiNode out{name};
  // The materials of a world have the states in their names.
  if (states.empty()) out = split_luanti_param2(name);
  // The param2 is the last of the states.
  const std::size_t last = states.rfind(',') + 1;  // 0 if there is one state or none
  if (const auto param2 = luanti_param2(states.substr(last))) {
    out.param2 = *param2;
    // Those of a file may have them there as well (node_material_name()).
    if (states_in_name(name) == states) out.name = name.substr(0, name.find('['));
    states = states.substr(0, last == 0 ? 0 : last - 1);
  }
  out.name = mts_name(out.name);
  // A name that ends so would be read as a name with states.
  if (!states.empty() || (out.name.ends_with(']') && out.name.find('[') != std::string::npos))
    out.name += "[" + std::string(states) + "]";
  return out;
}

class MtsWriter {
 public:
  explicit MtsWriter(const FormatSink& sink) : sink_(sink) {}

  /// Packs bytes, and gives what is packed to the sink.
  Result<void> give(ByteView bytes) {
    deflater_.write(bytes);
    return flush();
  }
  /// Ends the stream.
  Result<void> finish() {
    deflater_.finish();
    return flush();
  }

  /// Packs what `bytes_of` gives for each cell: `width` bytes a cell, the upper one first.
  template <class F>
  Result<void> give_plane(const Build& build, unsigned width, F&& bytes_of) {
    Bytes buffer;
    const auto walked =
        walk_cells(build, AxisOrder::xyz, [&](std::uint32_t count, std::uint16_t cell) {
          const unsigned value = bytes_of(cell);
          for (std::uint32_t i = 0; i < count; ++i) {
            if (width == 2) buffer.push_back(static_cast<std::uint8_t>(value >> 8));
            buffer.push_back(static_cast<std::uint8_t>(value));
          }
          if (buffer.size() < kMtsPart) return Result<void>{};
          Result<void> given = give(buffer);
          buffer.clear();
          return given;
        });
    if (!walked) return walked;
    return give(buffer);
  }

 private:
  Result<void> flush() {
    const bool is_taken = packed_.empty() || sink_(packed_);
    packed_.clear();
    if (!is_taken) return fail(ErrorCode::io_failed, "mts: cannot be written");
    return {};
  }

  const FormatSink& sink_;
  Bytes packed_;
  Deflater deflater_{DeflateForm::zlib, kMtsLevel, packed_};
};

}  // namespace

Result<ForeignInfo> read_mts(ByteView file, const PieceSink& sink) {
  const auto head = read_mts_head(file);
  if (!head) return failure(head.error());
  const ByteView packed = file.subspan(head->nodes_at);
  const VoxelPos sides = head->sides;
  const std::uint64_t count = static_cast<std::uint64_t>(sides.x) *
                              static_cast<std::uint64_t>(sides.y) *
                              static_cast<std::uint64_t>(sides.z);
  // The stream has all ids, then all chances, and then every param2, so it is read in three places.
  const auto form = DeflateForm::zlib;
  InflateSource ids(packed, form), chances(packed, form), params(packed, form);
  const auto cut = [&](const InflateSource& source) {
    return fail(source.is_damaged() ? ErrorCode::bad_value : ErrorCode::truncated,
                source.is_damaged() ? "mts: nodes are no zlib stream, or a damaged one"
                                    : "mts: fewer nodes than the sides say",
                head->nodes_at + source.offset());
  };
  // Deflate makes at most 1,032 bytes of one.
  if (4 * count / 1032 > packed.size() + 64) return cut(ids);
  if (!params.skip(3 * count)) return cut(params);
  if (!chances.skip(2 * count)) return cut(chances);
  MtsBlocks blocks(*head);
  if (!GridPieces::are_sides(sides, AxisOrder::xyz))
    return fail(ErrorCode::limit_exceeded, "mts: a layer has more than 268435456 nodes", 6);
  GridPieces pieces({{0, 0, 0}, sides}, AxisOrder::xyz, blocks.blocks(), sink);
  std::array<std::uint8_t, 2 * kMtsPart> id_bytes;
  std::array<std::uint8_t, kMtsPart> chance_bytes, param_bytes;
  std::uint64_t place = 0;
  const auto wide = static_cast<std::uint64_t>(sides.x);
  while (place < count) {
    const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(kMtsPart, count - place));
    if (!ids.read(std::span(id_bytes).first(2 * part))) return cut(ids);
    if (!chances.read(std::span(chance_bytes).first(part))) return cut(chances);
    if (!params.read(std::span(param_bytes).first(part))) return cut(params);
    for (std::size_t i = 0; i < part; ++i, ++place) {
      const auto id = static_cast<std::uint16_t>(id_bytes[2 * i] << 8 | id_bytes[2 * i + 1]);
      if (id >= head->names.size())
        return fail(ErrorCode::bad_value, "mts: a node has no name", head->nodes_at + ids.offset());
      // Before version 2, a chance of 0 means always.
      const unsigned chance = chance_bytes[i] & (head->version >= 4 ? 127U : 255U);
      const auto y = static_cast<std::size_t>(place / wide % static_cast<std::uint64_t>(sides.y));
      Material material = 0;
      if (head->is_layer_placed[y] && (chance != 0 || head->version < 2)) {
        const auto found = blocks.material(id, param_bytes[i]);
        if (!found)
          return fail(ErrorCode::limit_exceeded,
                      "mts: more than 65535 different nodes, or 32 MiB of their names",
                      head->nodes_at + ids.offset());
        material = *found;
      }
      if (auto done = pieces.append(1, material); !done) return failure(done.error());
    }
  }
  if (!params.finish()) {
    if (params.is_damaged()) return cut(params);
    return fail(ErrorCode::truncated, "mts: the nodes end early, or not with the last node",
                head->nodes_at + params.offset());
  }
  return ForeignInfo{};
}

Result<void> write_mts(const FileBuild& build, const FormatSink& sink) {
  RUNSTONE_ASSERT(build.materials.size() == build.build->palette().size());
  const VoxelPos sides = build.build->sides();
  if (std::max({sides.x, sides.y, sides.z}) > kMtsSideMax)
    return fail(ErrorCode::limit_exceeded, "mts: a side of the build is longer than 65,535");
  constexpr std::uint8_t kAlways = 127;
  std::vector<std::string> names = {"air"};  // untouched cells are air that is never placed
  std::map<std::string, std::uint16_t> ids = {{"air", 0}};
  struct Cell {
    std::uint16_t id = 0;
    std::uint8_t chance = 0, param2 = 0;
  };
  std::vector<Cell> cells = {{}};
  for (const BuildMaterial& material : build.materials) {
    const LuantiNode node = mts_node(material);
    const auto [known, is_new] =
        ids.try_emplace(node.name, static_cast<std::uint16_t>(names.size()));
    if (is_new) names.push_back(node.name);
    cells.push_back({known->second, kAlways, node.param2});
  }
  if (names.size() > 65'535)
    return fail(ErrorCode::limit_exceeded, "mts: build has more than 65,535 names");
  Bytes head = {'M', 'T', 'S', 'M'};
  const auto u16 = [&](std::size_t number) {
    head.push_back(static_cast<std::uint8_t>(number >> 8));
    head.push_back(static_cast<std::uint8_t>(number));
  };
  u16(4);
  for (const std::int32_t side : {sides.x, sides.y, sides.z}) u16(static_cast<std::size_t>(side));
  head.insert(head.end(), static_cast<std::size_t>(sides.y), kAlways);
  u16(names.size());
  for (const std::string& name : names) {
    u16(name.size());
    head.insert(head.end(), name.begin(), name.end());
  }
  if (!sink(head)) return fail(ErrorCode::io_failed, "mts: cannot be written");
  MtsWriter out(sink);
  const Build& voxels = *build.build;
  if (auto done = out.give_plane(voxels, 2, [&](std::uint16_t cell) { return cells[cell].id; });
      !done)
    return done;
  if (auto done = out.give_plane(voxels, 1, [&](std::uint16_t cell) { return cells[cell].chance; });
      !done)
    return done;
  if (auto done = out.give_plane(voxels, 1, [&](std::uint16_t cell) { return cells[cell].param2; });
      !done)
    return done;
  return out.finish();
}

}  // namespace runstone
