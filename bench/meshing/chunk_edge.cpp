#include "bench/meshing/chunk_edge.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/edits/edit_case.hpp"
#include "bench/harness/clocks.hpp"
#include "bench/harness/machine.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/worlds/measured_worlds.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "protocol/chunks/chunk_codec.hpp"

namespace runstone::bench {
namespace {

constexpr std::int32_t kRegionUnit = 64;  // every edge up to here divides the region
constexpr unsigned kPasses = 31;
constexpr std::size_t kEdits = 4000;  // about as many for each edge

/// Returns the voxels to cut: the whole units inside the bounds, or a cube of two units a side
/// around the ground.
VoxelBox region_of(const VoxelWorld& world) {
  if (!world.bounds) return {{0, -kRegionUnit, 0}, {2 * kRegionUnit, kRegionUnit, 2 * kRegionUnit}};
  VoxelBox box = *world.bounds;
  const auto whole = [](std::int32_t low, std::int32_t high) {
    return low + (high - low) / kRegionUnit * kRegionUnit;
  };
  box.max = {whole(box.min.x, box.max.x), whole(box.min.y, box.max.y), whole(box.min.z, box.max.z)};
  return box;
}

/// Returns the processor time of meshing all volumes once.
double mesh_pass_ns(const std::vector<Volume>& volumes, const VisibilityTable& visibility,
                    RdmScratch& scratch, ChunkMesh& mesh, std::size_t& quads) {
  quads = 0;
  const std::uint64_t start = core_ns();
  for (const Volume& volume : volumes) {
    mesh_rdm(volume.scene.chunk, volume.scene.pointers(), visibility, scratch, mesh);
    quads += mesh.quad_count();
  }
  return static_cast<double>(core_ns() - start);
}

/// The region of a world, cut at one edge.
struct Cut {
  ChunkEdgeRow row;
  std::vector<Volume> volumes;
  std::vector<double> passes;  // ns
};

Cut cut_region(const VoxelWorld& world, unsigned edge) {
  Cut out;
  ChunkEdgeRow& row = out.row;
  row.world = world.name;
  row.edge = edge;
  out.volumes = volumes_in(world, region_of(world), edge);
  row.chunks = out.volumes.size();
  for (const Volume& volume : out.volumes) {
    const RunChunk& chunk = volume.scene.chunk;
    row.uniform += chunk.is_uniform() ? 1 : 0;
    row.runs += chunk.runs.size();
    row.voxels += chunk.volume();
    row.run_bytes += chunk.runs.byte_size();
    if (!chunk.is_uniform()) row.mixed_bytes += chunk.runs.byte_size();
    row.memory_bytes += chunk.runs.byte_capacity() + sizeof(RunChunk);
    row.packed_bytes += encode_chunk(chunk, ChunkEncoding::packed).size();
  }
  return out;
}

void measure_edits_of(Cut& cut, const VoxelWorld& world) {
  std::erase_if(cut.volumes, [](const Volume& volume) { return volume.scene.chunk.is_uniform(); });
  const auto per_volume = static_cast<unsigned>(kEdits / (cut.volumes.size() + 1) + 1);
  const EditTiming edits = measure_edits(world, cut.volumes, per_volume, 1);
  cut.row.edit_ns = edits.all_ns;
  cut.row.edit_full_mesh_ns = edits.full_mesh_ns;
}

/// Measures one world at all edges. The passes of the edges alternate, so that noise of the machine
/// affects all of them alike.
void measure(const VoxelWorld& world, const std::vector<unsigned>& edges,
             std::vector<ChunkEdgeRow>& out) {
  std::vector<Cut> cuts;
  cuts.reserve(edges.size());
  for (const unsigned edge : edges) cuts.push_back(cut_region(world, edge));
  RdmScratch scratch;
  ChunkMesh mesh;
  for (unsigned pass = 0; pass < kPasses; ++pass) {
    for (Cut& cut : cuts) {
      cut.passes.push_back(
          mesh_pass_ns(cut.volumes, *world.visibility, scratch, mesh, cut.row.quads));
    }
  }
  for (Cut& cut : cuts) {
    cut.row.mesh_ns = median(cut.passes);
    measure_edits_of(cut, world);
    out.push_back(cut.row);
  }
}

}  // namespace

Result<std::vector<ChunkEdgeRow>, std::string> run_chunk_edge(const BenchOptions& options,
                                                              std::ostream& progress) {
  for (const unsigned edge : options.edges) {
    if (kRegionUnit % static_cast<std::int32_t>(edge) != 0) {
      return failure(fmt::format("edge {}: 8, 16, 32 and 64 divide a region", edge));
    }
  }
  std::vector<std::string> names = options.worlds;
  if (names.empty()) {
    const auto all = landscape_names();
    names.assign(all.begin(), all.end());
  }
  const auto worlds = MeasuredWorlds::open(names, options.luanti);
  if (!worlds) return failure(worlds.error());
  std::vector<ChunkEdgeRow> out;
  for (std::size_t w = 0; w < worlds->size(); ++w) {
    measure(*worlds->voxels(w), options.edges, out);
    fmt::print(progress, "{}\n", worlds->name(w));
    progress.flush();
  }
  return out;
}

void write_table(const std::vector<ChunkEdgeRow>& rows, std::ostream& out) {
  fmt::print(out,
             "\n| world | edge | chunks (uniform) | runs | runs B/voxel | memory B/voxel | "
             "packed B/voxel | quads | mesh ns/voxel | of a chunk that is not uniform: runs B | "
             "full mesh µs | edit µs |\n"
             "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const ChunkEdgeRow& row : rows) {
    const auto voxels = static_cast<double>(row.voxels);
    const auto per_voxel = [&](std::size_t bytes) { return static_cast<double>(bytes) / voxels; };
    const auto mixed = static_cast<double>(std::max<std::size_t>(row.chunks - row.uniform, 1));
    fmt::print(out,
               "| {} | {} | {} ({}) | {} | {:.4f} | {:.4f} | {:.4f} | {} | {:.3f} | {:.0f} | "
               "{:.2f} | {:.2f} |\n",
               row.world, row.edge, row.chunks, row.uniform, row.runs, per_voxel(row.run_bytes),
               per_voxel(row.memory_bytes), per_voxel(row.packed_bytes), row.quads,
               row.mesh_ns / voxels, static_cast<double>(row.mixed_bytes) / mixed,
               row.edit_full_mesh_ns / 1000, row.edit_ns / 1000);
  }
}

void write_csv(const std::vector<ChunkEdgeRow>& rows, std::ostream& out) {
  fmt::print(out,
             "world,edge,chunks,uniform,runs,voxels,run_bytes,mixed_bytes,memory_bytes,"
             "packed_bytes,quads,mesh_ns,edit_ns,edit_full_mesh_ns\n");
  for (const ChunkEdgeRow& row : rows) {
    fmt::print(out, "{},{},{},{},{},{},{},{},{},{},{},{:.0f},{:.0f},{:.0f}\n", row.world, row.edge,
               row.chunks, row.uniform, row.runs, row.voxels, row.run_bytes, row.mixed_bytes,
               row.memory_bytes, row.packed_bytes, row.quads, row.mesh_ns, row.edit_ns,
               row.edit_full_mesh_ns);
  }
}

void write_json(const std::vector<ChunkEdgeRow>& rows, std::ostream& out) {
  auto json = nlohmann::ordered_json::array();
  for (const ChunkEdgeRow& row : rows) {
    json.push_back({{"world", row.world},
                    {"edge", row.edge},
                    {"chunks", row.chunks},
                    {"uniform", row.uniform},
                    {"runs", row.runs},
                    {"voxels", row.voxels},
                    {"run_bytes", row.run_bytes},
                    {"mixed_bytes", row.mixed_bytes},
                    {"memory_bytes", row.memory_bytes},
                    {"packed_bytes", row.packed_bytes},
                    {"quads", row.quads},
                    {"mesh_ns", row.mesh_ns},
                    {"edit_ns", row.edit_ns},
                    {"edit_full_mesh_ns", row.edit_full_mesh_ns}});
  }
  out << json.dump(1) << '\n';
}

}  // namespace runstone::bench
