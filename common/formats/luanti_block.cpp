#include "common/formats/luanti_block.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/formats/deflate.hpp"
#include "common/formats/luanti_stream.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

// The first version with ids of two bytes, the first one with a word of lighting, and the first one
// that is a zstd stream as a whole. No version after that is known.
constexpr std::uint8_t kFirstVersion = 24, kLightingVersion = 27, kZstdVersion = 29;
constexpr std::uint32_t kNodeCount = kLuantiBlockEdge * kLuantiBlockEdge * kLuantiBlockEdge;
constexpr std::size_t kNodeIdBytes = 2, kNodeParamBytes = 2;
// A block cannot use more names than it has nodes, and i + 1 must fit a material id.
constexpr std::size_t kNameCountMax = kNodeCount;
// Metadata before version 29 precedes the names, so it has to be decompressed. It is not kept.
constexpr std::size_t kMetadataBytesMax = std::size_t{64} << 20;

/// Reads big-endian numbers with the common reader.
class BigEndian {
 public:
  explicit BigEndian(ByteReader& in) : in_(in) {}
  std::uint16_t u16() {
    const unsigned high = in_.u8();
    return static_cast<std::uint16_t>(high << 8 | in_.u8());
  }

 private:
  ByteReader& in_;
};

/// The block's name table, which maps its node ids to materials. Ids are few and small in practice,
/// but any u16 may occur.
struct NameTable {
  std::vector<ForeignBlock> blocks;
  // Node id and material, sorted by id.
  std::vector<std::pair<std::uint16_t, Material>> of_id;
  // The materials of names with a param2 that is not 0.
  std::map<std::pair<Material, std::uint8_t>, Material> of_state;
  std::size_t state_bytes = 0;  // of the names that were repeated for their states

  std::optional<Material> find(std::uint16_t id, std::uint8_t param2) {
    const auto at = std::lower_bound(of_id.begin(), of_id.end(), std::pair{id, Material{0}});
    if (at == of_id.end() || at->first != id) return std::nullopt;
    if (param2 == 0 || at->second == kEmpty) return at->second;
    const auto next = static_cast<Material>(blocks.size() + 1);
    const auto [state, is_new] = of_state.try_emplace({at->second, param2}, next);
    if (is_new) {
      const std::string& name = blocks[at->second - 1u].name;
      state_bytes += name.size();
      blocks.push_back({name, "param2=" + std::to_string(param2)});
    }
    return state->second;
  }
};

NameTable read_names(ByteReader& in) {
  BigEndian big(in);
  NameTable table;
  if (in.u8() != 0)
    in.reject(ErrorCode::bad_version, "luanti block: unknown version of the name table");
  const std::uint16_t count = big.u16();
  if (count > kNameCountMax)
    in.reject(ErrorCode::limit_exceeded, "luanti block: more than 4096 names");
  std::size_t name_bytes = 0;
  for (std::uint16_t i = 0; i < count && in.ok(); ++i) {
    const std::uint16_t id = big.u16();
    const ByteView name = in.bytes(big.u16());
    name_bytes += name.size();
    if (name_bytes > kLuantiBlockBytesMax) {
      in.reject(ErrorCode::limit_exceeded, "luanti block: names take more than 1 MiB");
      break;
    }
    table.blocks.push_back({std::string(name.begin(), name.end()), ""});
    table.of_id.emplace_back(
        id, table.blocks.back().name == "ignore" ? kEmpty : static_cast<Material>(i + 1));
  }
  std::sort(table.of_id.begin(), table.of_id.end());
  for (std::size_t i = 1; i < table.of_id.size(); ++i) {
    if (table.of_id[i - 1].first == table.of_id[i].first) {
      in.reject(ErrorCode::bad_value, "luanti block: an id has two names");
    }
  }
  return table;
}

void read_widths(ByteReader& in) {
  if (in.u8() != kNodeIdBytes)
    in.reject(ErrorCode::bad_value, "luanti block: node ids are not of 2 bytes");
  if (in.u8() != kNodeParamBytes)
    in.reject(ErrorCode::bad_value, "luanti block: parameters are not of 2 bytes");
}

/// Reads the planes of ids, light and param2, and makes runs of them. They are the other program's
/// dense form, which is read node by node from the place where it was decompressed, so no dense
/// buffer of this project is made.
Result<ForeignPiece> read_nodes(ByteReader& in, NameTable table) {
  const std::uint64_t plane_at = in.offset();
  const ByteView plane = in.bytes(kNodeCount * kNodeIdBytes);
  in.bytes(kNodeCount);  // param1: the light
  const ByteView param2 = in.bytes(kNodeCount);
  if (!in.ok()) return failure(in.error());

  RunBuilder runs(Extent::cube(kLuantiBlockEdge), AxisOrder::xyz);
  std::uint32_t first = 0;  // node at which the current stretch of one id and param2 began
  const auto id_at = [&](std::uint32_t node) {
    return static_cast<std::uint16_t>(plane[2 * node] << 8 | plane[2 * node + 1]);
  };
  for (std::uint32_t node = 1; node <= kNodeCount; ++node) {
    if (node < kNodeCount && id_at(node) == id_at(first) && param2[node] == param2[first]) continue;
    const auto material = table.find(id_at(first), param2[first]);
    if (!material)
      return fail(ErrorCode::bad_value, "luanti block: a node id has no name",
                  plane_at + 2 * first);
    if (table.state_bytes > kLuantiBlockBytesMax)
      return fail(ErrorCode::limit_exceeded, "luanti block: names and states take more than 1 MiB",
                  plane_at + 2 * first);
    runs.append(node - first, *material);
    first = node;
  }
  return ForeignPiece{{}, runs.finish(), std::move(table.blocks)};
}

/// Version 29: all but the version is one zstd stream, in which the names precede the nodes.
Result<ForeignPiece> decode_zstd_block(ByteView data) {
  const auto plain = unpack_zstd(data, 1, kLuantiBlockBytesMax);
  if (!plain) return failure(plain.error());
  ByteReader in(*plain);
  in.bytes(1 + 2 + 4);  // flags, lighting, timestamp
  NameTable table = read_names(in);
  read_widths(in);
  auto piece = read_nodes(in, std::move(table));
  if (!piece && piece.error().code == ErrorCode::truncated && plain->size() == kLuantiBlockBytesMax)
    return fail(ErrorCode::limit_exceeded, "luanti block: names take more than 1 MiB");
  return piece;
}

/// Versions 24 to 28: nodes and metadata are a zlib stream each, and the names come last.
Result<ForeignPiece> decode_zlib_block(ByteView data) {
  const std::uint8_t version = data[0];
  ByteReader head(data);
  head.bytes(version >= kLightingVersion ? 1 + 1 + 2 : 1 + 1);  // version, flags, lighting
  read_widths(head);
  if (!head.ok()) return failure(head.error());
  Bytes nodes;
  const auto behind_nodes =
      inflate_all(data, head.offset(), DeflateForm::zlib, kNodeCount * 4, &nodes);
  if (!behind_nodes) return failure(behind_nodes.error());
  const auto behind_metadata =
      inflate_all(data, *behind_nodes, DeflateForm::zlib, kMetadataBytesMax, nullptr);
  if (!behind_metadata) return failure(behind_metadata.error());

  ByteReader in(data);
  in.bytes(*behind_metadata);
  BigEndian big(in);
  // Timers follow the names since version 25.
  if (version == 24 && in.u8() != 0) in.bytes(std::size_t{big.u16()} * (2 + 4 + 4));
  in.u8();  // version of the static objects
  for (unsigned left = big.u16(); left > 0 && in.ok(); --left) {
    in.bytes(1 + 3 * 4);  // kind, position
    in.bytes(big.u16());
  }
  in.bytes(4);  // timestamp
  NameTable table = read_names(in);
  if (!in.ok()) return failure(in.error());
  ByteReader planes(nodes);
  return read_nodes(planes, std::move(table));
}

std::int32_t low_12_bits_signed(std::int64_t v) {
  const auto low = static_cast<std::int32_t>(v & 0xfff);
  return low < 2048 ? low : low - 4096;
}

}  // namespace

ChunkCoord luanti_block_coord(std::int64_t pos) {
  ChunkCoord out;
  // Each shift is exact, because the low 12 bits were just subtracted. The arithmetic is unsigned,
  // for a hostile pos near the ends of i64.
  auto rest = static_cast<std::uint64_t>(pos);
  out.x = low_12_bits_signed(static_cast<std::int64_t>(rest));
  rest = static_cast<std::uint64_t>(
      static_cast<std::int64_t>(rest - static_cast<std::uint64_t>(out.x)) >> 12);
  out.y = low_12_bits_signed(static_cast<std::int64_t>(rest));
  rest = static_cast<std::uint64_t>(
      static_cast<std::int64_t>(rest - static_cast<std::uint64_t>(out.y)) >> 12);
  out.z = low_12_bits_signed(static_cast<std::int64_t>(rest));
  return out;
}

std::int64_t luanti_block_pos(ChunkCoord block) {
  return (std::int64_t{block.z} * 4096 + block.y) * 4096 + block.x;
}

Result<ForeignPiece> decode_luanti_block(ByteView data) {
  if (data.empty()) return fail(ErrorCode::truncated, "luanti block: no bytes");
  if (data[0] == kZstdVersion) return decode_zstd_block(data);
  if (data[0] >= kFirstVersion && data[0] < kZstdVersion) return decode_zlib_block(data);
  return fail(ErrorCode::bad_version,
              data[0] < kFirstVersion ? "luanti block: of Luanti 0.4.1 or before"
                                      : "luanti block: of a newer Luanti than this program knows");
}

Result<ForeignInfo> read_luanti_block(ByteView data, const PieceSink& sink) {
  auto piece = decode_luanti_block(data);
  if (!piece) return failure(piece.error());
  if (const auto taken = sink(std::move(*piece)); !taken) return failure(taken.error());
  return ForeignInfo{};
}

}  // namespace runstone
