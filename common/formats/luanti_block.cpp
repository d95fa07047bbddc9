#include "common/formats/luanti_block.hpp"

#include <zstd.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

constexpr std::uint8_t kVersion = 29;
constexpr std::uint32_t kNodeCount = kLuantiBlockEdge * kLuantiBlockEdge * kLuantiBlockEdge;
constexpr std::size_t kNodeIdBytes = 2, kNodeParamBytes = 2;
// A block cannot use more names than it has nodes, and i + 1 must fit a material id.
constexpr std::size_t kNameCountMax = kNodeCount;

struct StreamDeleter {
  void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
};

/// Decompresses exactly one zstd frame. The streaming calls are needed, because Luanti writes no
/// content size.
Result<Bytes> decompress(ByteView in) {
  const std::unique_ptr<ZSTD_DStream, StreamDeleter> stream(ZSTD_createDStream());
  RUNSTONE_ASSERT(stream != nullptr);
  Bytes out(std::size_t{20} << 10);  // nearly every block fits: the nodes are 16 KiB
  ZSTD_inBuffer source{in.data(), in.size(), 0};
  std::size_t filled = 0;
  while (true) {
    ZSTD_outBuffer target{out.data(), out.size(), filled};
    const std::size_t status = ZSTD_decompressStream(stream.get(), &target, &source);
    const std::uint64_t offset = source.pos + 1;  // the version byte precedes the stream
    if (ZSTD_isError(status) != 0) {
      return fail(ErrorCode::bad_value, "luanti block: not a zstd stream, or a damaged one",
                  offset);
    }
    filled = target.pos;
    if (status == 0) {
      if (source.pos != source.size) {
        return fail(ErrorCode::trailing_bytes, "luanti block: bytes after the zstd stream", offset);
      }
      out.resize(filled);
      return out;
    }
    if (filled < out.size()) {
      // The output has room left, so the stream needs more input, but all input was consumed.
      return fail(ErrorCode::truncated, "luanti block: the zstd stream ends early", offset);
    }
    if (out.size() == kLuantiBlockBytesMax) {
      return fail(ErrorCode::limit_exceeded, "luanti block: decompresses to more than 1 MiB",
                  offset);
    }
    out.resize(std::min(out.size() * 4, kLuantiBlockBytesMax));
  }
}

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
  for (std::uint16_t i = 0; i < count && in.ok(); ++i) {
    const std::uint16_t id = big.u16();
    const ByteView name = in.bytes(big.u16());
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
  if (data[0] != kVersion)
    return fail(ErrorCode::bad_version, "luanti block: serialisation version is not 29");
  const auto plain = decompress(data.subspan(1));
  if (!plain) return failure(plain.error());

  ByteReader in(*plain);
  in.bytes(1 + 2 + 4);  // flags, lighting, timestamp
  NameTable table = read_names(in);
  if (in.u8() != kNodeIdBytes)
    in.reject(ErrorCode::bad_value, "luanti block: node ids are not of 2 bytes");
  if (in.u8() != kNodeParamBytes)
    in.reject(ErrorCode::bad_value, "luanti block: parameters are not of 2 bytes");
  // This plane is the other program's dense form. It is read node by node into runs, from the place
  // where it was decompressed, so no dense buffer of this project is made.
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

Result<void> read_luanti_block(ByteView data, const PieceSink& sink) {
  auto piece = decode_luanti_block(data);
  if (!piece) return failure(piece.error());
  return sink(std::move(*piece));
}

}  // namespace runstone
