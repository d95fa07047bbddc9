#include "bench/network/transfer_scene.hpp"

#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "bench/harness/clocks.hpp"
#include "common/core/assert.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/runs/dense.hpp"
#include "common/runs/reorder.hpp"
#include "protocol/codec/chunk_entries.hpp"
#include "protocol/codec/frame.hpp"
#include "protocol/codec/messages.hpp"
#include "tests/reference/binary_greedy.hpp"

namespace runstone::bench {
namespace {

using reference::BinaryScratch;
using reference::DenseGrid;

constexpr int kZstdLevel = 3;
constexpr AxisOrder kDenseOrder = AxisOrder::xyz;

/// The header before the voxels of a dense chunk.
struct DenseHeader {
  std::uint32_t body_bytes = 0;
  ChunkCoord at;
};
static_assert(sizeof(DenseHeader) == 16);

void append(Bytes& out, const void* from, std::size_t bytes) {
  const auto* first = static_cast<const std::uint8_t*>(from);
  out.insert(out.end(), first, first + bytes);
}

void append_dense(const ChunkCoord& at, const RunChunk& chunk, bool compressed, Bytes& out) {
  const std::vector<Material> voxels = to_dense(reorder(chunk, kDenseOrder));
  const std::size_t bytes = voxels.size() * sizeof(Material);
  if (!compressed) {
    const DenseHeader header{static_cast<std::uint32_t>(bytes), at};
    append(out, &header, sizeof header);
    append(out, voxels.data(), bytes);
    return;
  }
  Bytes body(ZSTD_compressBound(bytes));
  const std::size_t size =
      ZSTD_compress(body.data(), body.size(), voxels.data(), bytes, kZstdLevel);
  RUNSTONE_ASSERT(ZSTD_isError(size) == 0);
  const DenseHeader header{static_cast<std::uint32_t>(size), at};
  append(out, &header, sizeof header);
  append(out, body.data(), size);
}

std::uint64_t faces_of(const ChunkMesh& mesh) {
  std::uint64_t out = 0;
  for (const QuadLayers* pass : {&mesh.opaque, &mesh.transparent}) {
    for (const Quad quad : pass->quads) {
      const QuadFields fields = unpack(quad);
      out += std::uint64_t{fields.width} * fields.height;
    }
  }
  return out;
}

/// Reads dense chunks from a stream of bytes.
class DenseReader {
 public:
  DenseReader(unsigned edge, bool compressed) : edge_(edge), compressed_(compressed) {}

  /// Calls take(coordinate, voxels) for each complete chunk.
  template <class Take>
  Result<void, std::string> feed(ByteView bytes, std::uint64_t& unpack_ns, Take take) {
    append(buffer_, bytes.data(), bytes.size());
    std::size_t at = 0;
    for (;;) {
      DenseHeader header;
      if (buffer_.size() - at < sizeof header) break;
      std::memcpy(&header, buffer_.data() + at, sizeof header);
      const std::size_t whole = volume() * sizeof(Material);
      if (header.body_bytes > ZSTD_compressBound(whole))
        return failure("a dense chunk is too large");
      if (buffer_.size() - at - sizeof header < header.body_bytes) break;
      const std::uint8_t* const body = buffer_.data() + at + sizeof header;
      const std::uint64_t start = now_ns();
      voxels_.resize(volume());
      std::size_t got = header.body_bytes;
      if (compressed_) {
        got = ZSTD_decompressDCtx(context_.get(), voxels_.data(), whole, body, header.body_bytes);
      } else if (got == whole) {
        std::memcpy(voxels_.data(), body, whole);
      }
      if (got != whole) return failure("a dense chunk has not the size of its voxels");
      take(header.at, std::span<const Material>(voxels_));
      unpack_ns += now_ns() - start;
      at += sizeof header + header.body_bytes;
    }
    buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(at));
    return {};
  }

 private:
  std::size_t volume() const { return std::size_t{edge_} * edge_ * edge_; }
  struct FreeContext {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
  };
  const unsigned edge_;
  const bool compressed_;
  std::unique_ptr<ZSTD_DCtx, FreeContext> context_{ZSTD_createDCtx()};
  Bytes buffer_;
  std::vector<Material> voxels_;
};

void fill_inside(DenseGrid& grid, unsigned edge, std::span<const Material> voxels) {
  grid.reset(Extent::cube(edge), kDenseOrder);
  for (unsigned s = 0; s < edge; ++s) {
    for (unsigned m = 0; m < edge; ++m) {
      std::memcpy(grid.line(m, s), voxels.data() + (std::size_t{s} * edge + m) * edge,
                  edge * sizeof(Material));
    }
  }
}

/// Fills the border layer in one direction from the grid beside it; with empty voxels if there is
/// none.
void fill_border(DenseGrid& grid, const DenseGrid* beside, Direction direction, unsigned edge) {
  const Axis axis = axis_of(direction);
  const auto axes = axes_of(kDenseOrder);
  const Axis u = axis == axes[0] ? axes[1] : axes[0];
  const Axis v = axis == axes[2] ? axes[1] : axes[2];
  const std::ptrdiff_t side = edge;
  const std::ptrdiff_t to = is_positive(direction) ? side : -1,
                       from = is_positive(direction) ? 0 : side - 1;
  Material* const out = grid.line(0, 0);
  for (std::ptrdiff_t j = 0; j < side; ++j) {
    for (std::ptrdiff_t i = 0; i < side; ++i) {
      const std::ptrdiff_t across = i * grid.stride(u) + j * grid.stride(v);
      out[across + to * grid.stride(axis)] =
          beside == nullptr ? kEmpty : beside->origin()[across + from * grid.stride(axis)];
    }
  }
}

}  // namespace

const char* name_of(Transfer transfer) {
  constexpr std::array<const char*, 4> kNames = {"dense", "dense_zstd", "raw", "packed"};
  return kNames[static_cast<std::size_t>(transfer)];
}

Bytes encode_scene(const TransferScene& scene, Transfer transfer) {
  Bytes out;
  FrameWriter frames;
  ChunksBuilder chunks;
  for (const auto& [at, voxels] : scene.chunks) {
    if (transfer == Transfer::dense || transfer == Transfer::dense_zstd) {
      append_dense(at, voxels, transfer == Transfer::dense_zstd, out);
      continue;
    }
    const Chunk chunk{voxels, {1, 1}, digest_of(voxels)};
    ChunkEntry entry = encode_snapshot(
        {0, at}, chunk, transfer == Transfer::raw ? ChunkEncoding::raw : ChunkEncoding::packed);
    if (!chunks.fits(entry)) frames.append(chunks.take(1), out);
    chunks.add(std::move(entry));
  }
  if (!chunks.empty()) frames.append(chunks.take(1), out);
  return out;
}

struct SceneReceiver::Parts {
  Parts(const TransferScene& of, Transfer transfer)
      : scene(of),
        is_dense(transfer == Transfer::dense || transfer == Transfer::dense_zstd),
        dense(of.edge, transfer == Transfer::dense_zstd) {}

  Result<void, std::string> feed(ByteView bytes) {
    if (is_dense) {
      std::vector<ChunkCoord> came;
      const auto fed = dense.feed(bytes, times.unpack_ns,
                                  [&](const ChunkCoord& at, std::span<const Material> voxels) {
                                    fill_inside(grids[at], scene.edge, voxels);
                                    came.push_back(at);
                                  });
      for (const ChunkCoord& at : came) arrived(at);
      return fed;
    }
    const auto fed = frames.feed(bytes, [&](MessageKind kind, ByteView body) -> Result<void> {
      const std::uint64_t start = now_ns();
      auto message =
          decode_message(Sender::server, kind, body, static_cast<std::uint16_t>(scene.edge));
      if (!message) return failure(message.error());
      std::vector<ChunkCoord> came;
      for (ChunkAnswer& answer : std::get<Chunks>(*message).chunks) {
        auto& snapshot = std::get<ChunkSnapshot>(answer);
        if (!digest_matches(snapshot)) return fail(ErrorCode::bad_value, "not a sound snapshot");
        came.push_back(snapshot.key.at);
        runs[came.back()] = std::move(snapshot.chunk.voxels);
      }
      times.unpack_ns += now_ns() - start;
      for (const ChunkCoord& at : came) arrived(at);
      return {};
    });
    if (!fed) return failure(fed.error().what);
    return {};
  }

  bool is_here(const ChunkCoord& at) const {
    return is_dense ? grids.contains(at) : runs.contains(at);
  }

  /// Meshes the chunk and its neighbours, as far as their neighbours have arrived.
  void arrived(const ChunkCoord& at) {
    const std::uint64_t start = now_ns();
    mesh_if_ready(at);
    for (unsigned d = 0; d < kDirectionCount; ++d)
      mesh_if_ready(neighbour(at, static_cast<Direction>(d)));
    times.mesh_ns += now_ns() - start;
  }

  void mesh_if_ready(const ChunkCoord& at) {
    if (!is_here(at) || meshed.contains(at)) return;
    for (unsigned d = 0; d < kDirectionCount; ++d) {
      const ChunkCoord beside = neighbour(at, static_cast<Direction>(d));
      if (scene.chunks.contains(beside) && !is_here(beside)) return;
    }
    meshed.insert(at);
    is_dense ? mesh_grid(at) : mesh_runs(at);
    times.quads += mesh.quad_count();
    times.faces += faces_of(mesh);
  }

  void mesh_grid(const ChunkCoord& at) {
    DenseGrid& grid = grids.at(at);
    for (unsigned d = 0; d < kDirectionCount; ++d) {
      const auto beside = grids.find(neighbour(at, static_cast<Direction>(d)));
      fill_border(grid, beside == grids.end() ? nullptr : &beside->second,
                  static_cast<Direction>(d), scene.edge);
    }
    mesh_binary_greedy(grid, *scene.visibility, binary, mesh);
  }

  void mesh_runs(const ChunkCoord& at) {
    MeshNeighbours neighbours{};
    for (unsigned d = 0; d < kDirectionCount; ++d) {
      const auto beside = runs.find(neighbour(at, static_cast<Direction>(d)));
      if (beside != runs.end()) neighbours[d] = &beside->second;
    }
    mesh_rdm(runs.at(at), neighbours, *scene.visibility, rdm, mesh);
  }

  const TransferScene& scene;
  const bool is_dense;
  DenseReader dense;
  FrameReader frames{Sender::server};
  std::map<ChunkCoord, DenseGrid> grids;
  std::map<ChunkCoord, RunChunk> runs;
  std::set<ChunkCoord> meshed;
  BinaryScratch binary;
  RdmScratch rdm;
  ChunkMesh mesh;
  TransferTimes times;
};

SceneReceiver::SceneReceiver(const TransferScene& scene, Transfer transfer)
    : parts_(std::make_unique<Parts>(scene, transfer)) {}
SceneReceiver::~SceneReceiver() = default;
Result<void, std::string> SceneReceiver::feed(ByteView bytes) { return parts_->feed(bytes); }
bool SceneReceiver::complete() const {
  return parts_->meshed.size() == parts_->scene.chunks.size();
}
const TransferTimes& SceneReceiver::times() const { return parts_->times; }

}  // namespace runstone::bench
