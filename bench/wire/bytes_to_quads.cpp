#include "bench/wire/bytes_to_quads.hpp"

#include <fmt/ostream.h>
#include <zstd.h>

#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "bench/harness/clocks.hpp"
#include "bench/harness/machine_json.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/wire/chunks_beside.hpp"
#include "bench/worlds/measured_worlds.hpp"
#include "common/core/assert.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/runs/reorder.hpp"
#include "protocol/chunks/chunk_codec.hpp"
#include "tests/reference/binary_greedy.hpp"
#include "tests/reference/dense_bytes.hpp"

namespace runstone::bench {
namespace {

using reference::DenseBytes;

constexpr int kDenseZstdLevel = 5;  // as that of packed chunks

/// The times of the stages of one way, in µs, by pass.
struct StageTimes {
  std::vector<double> unpack, grid, mesh;
};

/// A chunk in both forms, with what its meshes need of its neighbours.
struct WireChunk {
  const Volume* volume = nullptr;
  IndicesBeside beside;  // chunks of the same world

  Bytes packed;
  ChunkBorders borders;
  bool has_borders = false;  // in this pass

  Bytes frame;  // the dense ids
  DenseBytes dense;
  std::array<std::optional<DenseBytes>, kDirectionCount> dense_beside;

  StageTimes runs_times, dense_times;
};

Bytes compressed(const DenseBytes& dense, std::uint32_t volume) {
  Bytes out(ZSTD_compressBound(volume));
  const std::size_t size =
      ZSTD_compress(out.data(), out.size(), dense.ids.data(), volume, kDenseZstdLevel);
  RUNSTONE_ASSERT(ZSTD_isError(size) == 0);
  out.resize(size);
  return out;
}

/// Makes the dense forms of a chunk and its neighbours. Returns nullopt if one of them has too many
/// materials.
std::optional<WireChunk> wire_chunk(const Volume& volume, const VisibilityTable& visibility) {
  WireChunk out;
  out.volume = &volume;
  auto dense = reference::dense_bytes(volume.scene.chunk, visibility);
  if (!dense) return std::nullopt;
  out.dense = *std::move(dense);
  for (std::size_t d = 0; d < kDirectionCount; ++d) {
    const auto& beside = volume.scene.neighbours[d];
    if (!beside) continue;
    out.dense_beside[d] =
        reference::dense_bytes(reorder(*beside, volume.scene.chunk.order), visibility);
    if (!out.dense_beside[d]) return std::nullopt;
  }
  out.packed = encode_chunk(volume.scene.chunk, ChunkEncoding::packed);
  out.frame = compressed(out.dense, volume.scene.chunk.volume());
  return out;
}

/// Returns the chunks of a world that are not uniform. Counts those with too many materials for a
/// dense form in left_out instead.
std::vector<WireChunk> chunks_of(const MeasuredWorld& world, std::size_t& left_out) {
  std::vector<WireChunk> out;
  std::vector<const Volume*> volumes;
  for (const Volume& volume : world.volumes) {
    if (volume.scene.chunk.is_uniform()) continue;
    auto chunk = wire_chunk(volume, *world.visibility);
    if (!chunk) {
      ++left_out;
      continue;
    }
    volumes.push_back(&volume);
    out.push_back(*std::move(chunk));
  }
  const std::vector<IndicesBeside> beside = indices_beside(volumes);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].beside = beside[i];
  return out;
}

/// Ends a stage: adds the time since `start` and returns the present time.
std::uint64_t end_stage(std::vector<double>& times, std::uint64_t start) {
  const std::uint64_t now = now_ns();
  times.push_back(static_cast<double>(now - start) / 1000);
  return now;
}

class RunsPath {
 public:
  /// Does all chunks in turn.
  void pass(std::vector<WireChunk>& chunks, const VisibilityTable& visibility) {
    for (WireChunk& chunk : chunks) chunk.has_borders = false;
    for (WireChunk& chunk : chunks) {
      MeshBorders borders{};
      for (std::size_t d = 0; d < kDirectionCount; ++d) {
        if (chunk.beside[d] && chunks[*chunk.beside[d]].has_borders)
          borders[d] = &chunks[*chunk.beside[d]].borders;
      }
      const MeshNeighbours neighbours = chunk.volume->scene.pointers();
      std::uint64_t at = now_ns();
      const auto unpacked = decode_chunk(chunk.packed);
      at = end_stage(chunk.runs_times.unpack, at);
      mesh_rdm(*unpacked, neighbours, borders, visibility, scratch_, mesh_, &chunk.borders);
      end_stage(chunk.runs_times.mesh, at);
      chunk.has_borders = true;
      RUNSTONE_ASSERT(*unpacked == chunk.volume->scene.chunk);
    }
  }

 private:
  RdmScratch scratch_;
  ChunkMesh mesh_;
};

class DensePath {
 public:
  DensePath() : decompressor_(ZSTD_createDCtx(), ZSTD_freeDCtx) {}

  void pass(std::vector<WireChunk>& chunks, const VisibilityTable& visibility) {
    for (WireChunk& chunk : chunks) {
      reference::DenseNeighbours neighbours{};
      for (std::size_t d = 0; d < kDirectionCount; ++d)
        neighbours[d] = chunk.dense_beside[d] ? &*chunk.dense_beside[d] : nullptr;
      const std::size_t volume = chunk.volume->scene.chunk.volume();
      std::uint64_t at = now_ns();
      const std::size_t size = ZSTD_decompressDCtx(decompressor_.get(), chunk.dense.ids.data(),
                                                   volume, chunk.frame.data(), chunk.frame.size());
      at = end_stage(chunk.dense_times.unpack, at);
      reference::fill_volume(chunk.dense, neighbours, visibility, scratch_.volume);
      at = end_stage(chunk.dense_times.grid, at);
      reference::mesh_binary_greedy(scratch_.volume, scratch_, mesh_);
      end_stage(chunk.dense_times.mesh, at);
      RUNSTONE_ASSERT(size == volume);
    }
  }

 private:
  std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> decompressor_;
  reference::BinaryScratch scratch_;
  ChunkMesh mesh_;
};

QuadsWay way_of(const std::vector<WireChunk>& chunks, StageTimes WireChunk::* times,
                Bytes WireChunk::* bytes) {
  QuadsWay out;
  const auto count = static_cast<double>(chunks.size());
  for (const WireChunk& chunk : chunks) {
    const StageTimes& stages = chunk.*times;
    const double unpack = median(stages.unpack), mesh = median(stages.mesh);
    const double grid = stages.grid.empty() ? 0 : median(stages.grid);
    out.unpack_us += unpack / count;
    out.grid_us += grid / count;
    out.mesh_us += mesh / count;
    out.total_us.push_back(unpack + grid + mesh);
    out.bytes += static_cast<double>((chunk.*bytes).size()) / count;
  }
  return out;
}

QuadsRow measure(const MeasuredWorld& world, unsigned edge, unsigned repetitions) {
  QuadsRow row;
  std::vector<WireChunk> chunks = chunks_of(world, row.left_out);
  RunsPath runs;
  DensePath dense;
  for (unsigned i = 0; i < repetitions; ++i) {
    runs.pass(chunks, *world.visibility);
    dense.pass(chunks, *world.visibility);
  }
  row.world = world.name;
  row.edge = edge;
  row.chunks = chunks.size();
  row.runs = way_of(chunks, &WireChunk::runs_times, &WireChunk::packed);
  row.dense = way_of(chunks, &WireChunk::dense_times, &WireChunk::frame);
  if (chunks.empty()) return row;
  std::vector<double> gains;
  for (std::size_t i = 0; i < chunks.size(); ++i)
    gains.push_back(row.dense.total_us[i] / row.runs.total_us[i]);
  row.gain_mean = geometric_mean(gains);
  row.gain_sums = row.dense.mean_us() / row.runs.mean_us();
  return row;
}

}  // namespace

std::vector<Target> QuadsResult::targets() const {
  std::vector<Target> out;
  for (const QuadsRow& row : rows) {
    if (row.world != "luanti" || row.edge != 32) continue;
    out.push_back(without_target("luanti, edge 32: packed bytes to quads, mean of a chunk",
                                 fmt::format("{:.1f} µs", row.runs.mean_us())));
    out.push_back(without_target("the same against dense bytes: geometric mean; ratio of sums",
                                 fmt::format("{:.2f}x; {:.2f}x", row.gain_mean, row.gain_sums)));
  }
  return out;
}

Result<QuadsResult, std::string> run_bytes_to_quads(const BenchOptions& options,
                                                    std::ostream& progress) {
  const auto worlds = MeasuredWorlds::open(options.worlds, options.luanti);
  if (!worlds) return failure(worlds.error());
  QuadsResult out;
  out.machine = this_machine();
  out.repetitions = options.repetitions;
  std::vector<std::string> skipped;
  worlds->measure_each(
      options.edges,
      [&](std::size_t, const MeasuredWorld& world, unsigned edge) {
        if (world.volumes.empty()) return;
        if (edge > reference::kBinarySideMax) {
          fmt::print(progress, "{} edge {}: left out, binary greedy has sides up to {}\n",
                     world.name, edge, reference::kBinarySideMax);
          return;
        }
        out.rows.push_back(measure(world, edge, options.repetitions));
      },
      skipped, progress);
  return out;
}

void write_table(const QuadsResult& result, std::ostream& out) {
  fmt::print(out,
             "{} passes over all chunks of a world\n\n"
             "| world | edge | chunks | way | bytes | unpack µs | grid and mask µs | mesh µs | "
             "total µs | x dense: geometric mean; sums |\n"
             "|---|---|---|---|---|---|---|---|---|---|\n",
             result.repetitions);
  for (const QuadsRow& row : result.rows) {
    const auto print = [&](const char* name, const QuadsWay& way, const std::string& grid,
                           const std::string& gain) {
      fmt::print(out, "| {} | {} | {} | {} | {:.0f} | {:.1f} | {} | {:.1f} | {:.1f} | {} |\n",
                 row.world, row.edge, row.chunks, name, way.bytes, way.unpack_us, grid, way.mesh_us,
                 way.mean_us(), gain);
    };
    print("runs", row.runs, "–", fmt::format("{:.2f}; {:.2f}", row.gain_mean, row.gain_sums));
    print("dense", row.dense, fmt::format("{:.1f}", row.dense.grid_us), "1.00; 1.00");
  }
  fmt::print(out, "\n");
  write_targets(result.targets(), out);
}

void write_json(const QuadsResult& result, std::ostream& out) {
  const auto json_of_way = [](const QuadsWay& way) {
    return nlohmann::ordered_json{{"bytes", way.bytes},
                                  {"unpack_us", way.unpack_us},
                                  {"grid_us", way.grid_us},
                                  {"mesh_us", way.mesh_us},
                                  {"total_us", way.mean_us()}};
  };
  nlohmann::ordered_json json = {{"machine", json_of(result.machine)},
                                 {"repetitions", result.repetitions},
                                 {"rows", nlohmann::ordered_json::array()}};
  for (const QuadsRow& row : result.rows) {
    json["rows"].push_back({{"world", row.world},
                            {"edge", row.edge},
                            {"chunks", row.chunks},
                            {"left_out", row.left_out},
                            {"runs", json_of_way(row.runs)},
                            {"dense", json_of_way(row.dense)},
                            {"gain_mean", row.gain_mean},
                            {"gain_sums", row.gain_sums}});
  }
  out << json.dump(1) << '\n';
}

}  // namespace runstone::bench
