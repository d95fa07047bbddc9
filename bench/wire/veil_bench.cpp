#include "bench/wire/veil_bench.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/harness/clocks.hpp"
#include "bench/harness/machine_json.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/wire/chunks_beside.hpp"
#include "bench/worlds/measured_worlds.hpp"
#include "common/core/assert.hpp"
#include "common/materials/veil_visibility.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/runs/reorder.hpp"
#include "common/veil/uncovered.hpp"
#include "common/veil/veil.hpp"
#include "protocol/chunks/chunk_codec.hpp"

namespace runstone::bench {
namespace {

/// The chunk in one form, as a server sends it and a client meshes it.
struct VeilForm {
  RunChunk voxels;
  Bytes packed;
  ChunkBorders borders;
  std::size_t quads = 0;
  std::vector<double> unpack_us, mesh_us;
};
constexpr std::size_t kForms = 3;  // plain, veiled, turned

struct VeilChunk {
  const Volume* volume = nullptr;
  IndicesBeside beside;  // chunks of the same world
  std::array<VeilForm, kForms> forms;
  std::vector<double> veil_us, uncover_us;
};

double veil_us_since(std::uint64_t start) { return static_cast<double>(now_ns() - start) / 1000; }

/// Returns the chunks of a world that are not uniform, without forms.
std::vector<VeilChunk> veil_chunks_of(const MeasuredWorld& world) {
  std::vector<const Volume*> volumes;
  for (const Volume& volume : world.volumes) {
    if (!volume.scene.chunk.is_uniform()) volumes.push_back(&volume);
  }
  const std::vector<IndicesBeside> beside = indices_beside(volumes);
  std::vector<VeilChunk> out(volumes.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].volume = volumes[i];
    out[i].beside = beside[i];
  }
  return out;
}

/// Makes the veil of each chunk in turn.
void veil_all(std::vector<VeilChunk>& chunks, const VeilMaterials& materials,
              VeilScratch& scratch) {
  for (VeilChunk& chunk : chunks) {
    const std::uint64_t start = now_ns();
    RunChunk veil =
        veil_of(chunk.volume->scene.chunk, chunk.volume->scene.pointers(), materials, scratch);
    chunk.veil_us.push_back(veil_us_since(start));
    chunk.forms[1].voxels = std::move(veil);
  }
}

/// Digs a voxel out of each chunk, the first one that covers at or behind the middle, and finds the
/// uncovered voxels. The shown chunk has the axis order of the true chunk, as in a server.
void dig_all(std::vector<VeilChunk>& chunks, const VeilMaterials& materials, VeilScratch& scratch) {
  VeilPatch patch;
  for (VeilChunk& chunk : chunks) {
    RunChunk truth = chunk.volume->scene.chunk;
    RunChunk shown = reorder(chunk.forms[1].voxels, truth.order);
    std::size_t run = find_run(truth, truth.volume() / 2);
    while (run + 1 < truth.runs.size() &&
           materials.covers[truth.runs.material(run)] != Visibility::opaque)
      ++run;
    const VoxelIndex at = std::max(truth.runs.begin(run), truth.volume() / 2);
    DirtyLayers dirty;
    const LocalPos p = pos_of(at, truth.extent, truth.order);
    for (const auto& [axis, place] : {std::pair{0u, p.x}, {1u, p.y}, {2u, p.z}})
      dirty.layer[axis].set(place);
    fill(truth, at, 1, kEmpty);
    fill(shown, at, 1, kEmpty);
    const MeshNeighbours beyond = chunk.volume->scene.pointers();
    const std::uint64_t start = now_ns();
    const SlowLayers layers = layers_beside(truth, dirty, {});
    const VeilBorders borders(truth, beyond, materials.covers, MissingSide::closed, layers);
    find_uncovered(truth, borders, shown, materials, layers, scratch, patch);
    const bool is_changed = apply_patch(patch, shown);
    chunk.uncover_us.push_back(veil_us_since(start));
    RUNSTONE_ASSERT(is_changed == !patch.empty());
  }
}

/// Unpacks and meshes each chunk of one form in turn.
class ReceivePass {
 public:
  void pass(std::vector<VeilChunk>& chunks, std::size_t form, const VisibilityTable& visibility) {
    std::vector<bool> has_borders(chunks.size());
    for (std::size_t i = 0; i < chunks.size(); ++i) {
      VeilForm& own = chunks[i].forms[form];
      MeshNeighbours neighbours = chunks[i].volume->scene.pointers();
      MeshBorders borders{};
      for (std::size_t d = 0; d < kDirectionCount; ++d) {
        if (!chunks[i].beside[d]) continue;
        VeilForm& other = chunks[*chunks[i].beside[d]].forms[form];
        neighbours[d] = &other.voxels;
        if (has_borders[*chunks[i].beside[d]] && !other.voxels.is_uniform())
          borders[d] = &other.borders;
      }
      std::uint64_t start = now_ns();
      const auto unpacked = decode_chunk(own.packed);
      own.unpack_us.push_back(veil_us_since(start));
      start = now_ns();
      mesh_rdm(*unpacked, neighbours, borders, visibility, scratch_, mesh_, &own.borders);
      own.mesh_us.push_back(veil_us_since(start));
      own.quads = mesh_.quad_count();
      has_borders[i] = true;
      RUNSTONE_ASSERT(*unpacked == own.voxels);
    }
  }

 private:
  RdmScratch scratch_;
  ChunkMesh mesh_;
};

VeilWay veil_way_of(const std::vector<VeilChunk>& chunks, std::size_t form) {
  VeilWay out;
  const auto count = static_cast<double>(chunks.size());
  for (const VeilChunk& chunk : chunks) {
    const VeilForm& own = chunk.forms[form];
    out.runs += static_cast<double>(own.voxels.runs.size()) / count;
    out.bytes += static_cast<double>(own.packed.size()) / count;
    out.quads += static_cast<double>(own.quads) / count;
    out.unpack_us += median(own.unpack_us) / count;
    out.mesh_us += median(own.mesh_us) / count;
  }
  return out;
}

VeilRow measure_veil(const MeasuredWorld& world, const VisibilityTable& covers, unsigned edge,
                     unsigned repetitions) {
  VeilRow row;
  row.world = world.name;
  row.edge = edge;
  std::vector<VeilChunk> chunks = veil_chunks_of(world);
  row.chunks = chunks.size();
  if (chunks.empty()) return row;
  const VeilMaterials materials{covers, veil_filler(covers)};
  VeilScratch scratch;
  for (unsigned i = 0; i < repetitions; ++i) veil_all(chunks, materials, scratch);
  for (unsigned i = 0; i < repetitions; ++i) dig_all(chunks, materials, scratch);
  for (VeilChunk& chunk : chunks) {
    chunk.forms[0].voxels = chunk.volume->scene.chunk;
    chunk.forms[2].voxels = in_cheapest_order(chunk.forms[1].voxels);
    for (VeilForm& form : chunk.forms)
      form.packed = encode_chunk(form.voxels, ChunkEncoding::packed);
    row.veil_us += median(chunk.veil_us) / static_cast<double>(chunks.size());
    row.uncover_us += median(chunk.uncover_us) / static_cast<double>(chunks.size());
  }
  ReceivePass receive;
  for (unsigned i = 0; i < repetitions; ++i) {
    for (std::size_t form = 0; form < kForms; ++form) receive.pass(chunks, form, *world.visibility);
  }
  row.plain = veil_way_of(chunks, 0);
  row.veiled = veil_way_of(chunks, 1);
  row.turned = veil_way_of(chunks, 2);
  return row;
}

}  // namespace

std::vector<Target> VeilResult::targets() const {
  std::vector<Target> out;
  for (const VeilRow& row : rows) {
    if (row.world != "luanti" || row.edge != 32 || row.chunks == 0) continue;
    const double ratio = row.veiled.bytes / row.plain.bytes;
    out.push_back({"luanti, edge 32: packed bytes with a veil against those without",
                   "at most 0.38x", fmt::format("{:.2f}x", ratio),
                   ratio <= 0.38 ? Verdict::met : Verdict::missed});
    out.push_back(without_target(
        "the same: packed bytes to quads, mean of a chunk",
        fmt::format("{:.1f} µs; {:.1f} µs without", row.veiled.both_us(), row.plain.both_us())));
  }
  return out;
}

Result<VeilResult, std::string> run_veil_bench(const BenchOptions& options,
                                               std::ostream& progress) {
  const auto worlds = MeasuredWorlds::open(options.worlds, options.luanti);
  if (!worlds) return failure(worlds.error());
  VeilResult out;
  out.machine = this_machine();
  out.repetitions = options.repetitions;
  std::vector<std::string> skipped;
  worlds->measure_each(
      options.edges,
      [&](std::size_t number, const MeasuredWorld& world, unsigned edge) {
        if (world.volumes.empty()) return;
        const VoxelWorld* voxels = worlds->voxels(number);
        // A scenario has visibilities but no material table. All its materials stop bodies.
        const VisibilityTable covers = voxels != nullptr && voxels->materials != nullptr
                                           ? VisibilityTable(veil_visibilities(*voxels->materials))
                                           : *world.visibility;
        out.rows.push_back(measure_veil(world, covers, edge, options.repetitions));
      },
      skipped, progress);
  return out;
}

void write_table(const VeilResult& result, std::ostream& out) {
  fmt::print(out,
             "{} passes over all chunks of a world; means of a chunk\n\n"
             "| world | edge | chunks | form | runs | packed bytes | unpack µs | mesh µs | both | "
             "quads | veil µs | uncover µs |\n"
             "|---|---|---|---|---|---|---|---|---|---|---|---|\n",
             result.repetitions);
  for (const VeilRow& row : result.rows) {
    const auto print = [&](const char* form, const VeilWay& way, const std::string& veil,
                           const std::string& uncover) {
      fmt::print(
          out,
          "| {} | {} | {} | {} | {:.0f} | {:.0f} | {:.1f} | {:.1f} | {:.2f}x | {:.0f} | {} | "
          "{} |\n",
          row.world, row.edge, row.chunks, form, way.runs, way.bytes, way.unpack_us, way.mesh_us,
          way.both_us() / row.plain.both_us(), way.quads, veil, uncover);
    };
    if (row.chunks == 0) continue;
    print("without", row.plain, "–", "–");
    print("veiled", row.veiled, fmt::format("{:.1f}", row.veil_us),
          fmt::format("{:.1f}", row.uncover_us));
    print("veiled, cheapest order", row.turned, "–", "–");
  }
  fmt::print(out, "\n");
  write_targets(result.targets(), out);
}

void write_json(const VeilResult& result, std::ostream& out) {
  const auto json_of_way = [](const VeilWay& way) {
    return nlohmann::ordered_json{{"runs", way.runs},           {"bytes", way.bytes},
                                  {"unpack_us", way.unpack_us}, {"mesh_us", way.mesh_us},
                                  {"both_us", way.both_us()},   {"quads", way.quads}};
  };
  nlohmann::ordered_json json = {{"machine", json_of(result.machine)},
                                 {"repetitions", result.repetitions},
                                 {"rows", nlohmann::ordered_json::array()}};
  for (const VeilRow& row : result.rows) {
    json["rows"].push_back({{"world", row.world},
                            {"edge", row.edge},
                            {"chunks", row.chunks},
                            {"plain", json_of_way(row.plain)},
                            {"veiled", json_of_way(row.veiled)},
                            {"turned", json_of_way(row.turned)},
                            {"veil_us", row.veil_us},
                            {"uncover_us", row.uncover_us}});
  }
  out << json.dump(1) << '\n';
}

}  // namespace runstone::bench
