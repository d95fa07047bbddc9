#include "bench/meshing/mesher_case.hpp"

#include <algorithm>
#include <bit>
#include <memory>
#include <vector>

#include "bench/harness/clocks.hpp"
#include "bench/meshing/grid_mesher_cases.hpp"
#include "bench/meshing/mesher_case_state.hpp"
#include "common/core/assert.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/runs/reorder.hpp"
#include "tests/reference/binary_greedy.hpp"
#include "tests/reference/culled_mesher.hpp"
#include "tests/reference/material_octree.hpp"
#include "tests/reference/palette_decode.hpp"
#include "tests/reference/rle_rdm.hpp"

namespace runstone::bench {
namespace {

using namespace reference;

constexpr std::array<std::string_view, 18> kNames = {"rdm",
                                                     "rdm_kept",
                                                     "rdm_plain",
                                                     "decode_binary",
                                                     "padded_binary",
                                                     "grid_binary",
                                                     "mask_binary",
                                                     "culled",
                                                     "simple",
                                                     "greedy",
                                                     "naive_greedy",
                                                     "run_strips",
                                                     "run_strips_hidden",
                                                     "optimal_greedy",
                                                     "monotone",
                                                     "poly2tri",
                                                     "grid_rdm",
                                                     "rle_rdm"};

/// Adds the time since `start` to a phase. Returns the present time.
std::uint64_t add_time(PhaseTimes& phases, Phase phase, std::uint64_t start) {
  const std::uint64_t now = now_ns();
  phases[static_cast<std::size_t>(phase)] += now - start;
  return now;
}

MesherCase rdm(std::string_view name, const Volume& volume, const VisibilityTable& visibility) {
  struct State {
    RdmScratch scratch;
    ChunkMesh mesh;
    MeshNeighbours neighbours;
    std::array<ChunkBorders, kDirectionCount> kept;
    MeshBorders borders{};
    ChunkBorders chunk_borders;
  };
  auto state = std::make_shared<State>();
  state->scratch.use_plain_path(name == "rdm_plain");
  state->neighbours = volume.scene.pointers();
  MesherCase out = case_over(state, volume.scene.chunk.runs.byte_size());
  ChunkBorders* chunk_borders = nullptr;
  if (name == "rdm_kept") {
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      if (state->neighbours[d] == nullptr) continue;
      state->kept[d].read(*state->neighbours[d], visibility);
      state->borders[d] = &state->kept[d];
    }
    chunk_borders = &state->chunk_borders;
    chunk_borders->read(volume.scene.chunk, visibility);
    out.storage_bytes += chunk_borders->byte_size();
  }
  out.mesh = [state, chunk_borders, &volume, &visibility](PhaseTimes&) {
    mesh_rdm(volume.scene.chunk, state->neighbours, state->borders, visibility, state->scratch,
             state->mesh, chunk_borders);
  };
  return out;
}

MesherCase binary_from_runs(std::string_view name, const Volume& volume,
                            const VisibilityTable& visibility) {
  struct State {
    GridNeighbours neighbours;
    PaddedRuns padded;
    BinaryScratch scratch;
    ChunkMesh mesh;
  };
  auto state = std::make_shared<State>();
  state->neighbours = volume.scene.pointers();
  const RunChunk& chunk = volume.scene.chunk;
  MesherCase out = case_over(state, chunk.runs.byte_size());
  if (name == "padded_binary") {
    auto padded = padded_runs(chunk, state->neighbours);
    RUNSTONE_ASSERT(padded);
    state->padded = *std::move(padded);
    out.storage_bytes = state->padded.ends.size() * (sizeof(std::uint32_t) + sizeof(PaletteId));
    out.mesh = [state, &visibility](PhaseTimes& phases) {
      const std::uint64_t start = now_ns();
      decode_palette(state->padded, visibility, state->scratch.volume);
      add_time(phases, Phase::decode, start);
      mesh_binary_greedy(state->scratch.volume, state->scratch, state->mesh);
    };
    return out;
  }
  out.mesh = [state, &chunk, &visibility](PhaseTimes& phases) {
    const std::uint64_t start = now_ns();
    const bool fits = decode_palette(chunk, state->neighbours, visibility, state->scratch.volume);
    add_time(phases, Phase::decode, start);
    if (!fits)
      return mesh_binary_greedy(chunk, state->neighbours, visibility, state->scratch, state->mesh);
    mesh_binary_greedy(state->scratch.volume, state->scratch, state->mesh);
  };
  return out;
}

MesherCase binary(std::string_view name, const Volume& volume, const VisibilityTable& visibility) {
  if (name != "mask_binary" && name != "grid_binary")
    return binary_from_runs(name, volume, visibility);
  struct State {
    DenseGrid grid;
    OccupancyMask mask;
    BinaryScratch scratch;
    ChunkMesh mesh;
  };
  auto state = std::make_shared<State>();
  const bool fits = decode_palette(volume.scene.chunk, volume.scene.pointers(), visibility,
                                   state->scratch.volume);
  RUNSTONE_ASSERT(fits);
  if (name == "mask_binary") {
    const PaletteVolume& ready = state->scratch.volume;
    MesherCase out = case_over(
        state, ready.grid.byte_size() + (ready.mask.opaque.size() + ready.mask.transparent.size()) *
                                            sizeof(std::uint64_t));
    out.mesh = [state](PhaseTimes&) {
      mesh_binary_greedy(state->scratch.volume, state->scratch, state->mesh);
    };
    return out;
  }
  decode(volume.scene.chunk, volume.scene.pointers(), state->scratch.volume.layer, state->grid);
  MesherCase out = case_over(state, state->grid.byte_size());
  out.mesh = [state, &visibility](PhaseTimes& phases) {
    const std::uint64_t start = now_ns();
    occupancy_of(state->grid, visibility, state->mask);
    add_time(phases, Phase::mask, start);
    mesh_binary_greedy(state->grid, state->mask, state->scratch, state->mesh);
  };
  return out;
}

/// Returns an empty octree that is deep enough for a cube of `side` voxels.
MaterialOctree octree_over(VoxelPos origin, std::int32_t side) {
  const auto bricks =
      static_cast<unsigned>((side + MaterialOctree::kBrickSide - 1) / MaterialOctree::kBrickSide);
  return {origin, static_cast<unsigned>(std::bit_width(bricks - 1))};
}

MesherCase culled(const Volume& volume, const VisibilityTable& visibility) {
  struct State {
    MaterialOctree octree;
    DenseGrid grid;
    std::vector<Quad> quads;
  };
  const auto side = static_cast<std::int32_t>(volume.edge);
  // The chunk lies at 0 0 0, and its neighbours around it.
  auto state = std::make_shared<State>(State{octree_over({-side, -side, -side}, 3 * side), {}, {}});
  MaterialOctree alone = octree_over({}, side);
  state->octree.insert({}, volume.scene.chunk);
  alone.insert({}, volume.scene.chunk);
  for (unsigned d = 0; d < kDirectionCount; ++d) {
    const auto& beside = volume.scene.neighbours[d];
    const VoxelPos at = origin_of(neighbour({}, static_cast<Direction>(d)), side);
    if (beside) state->octree.insert(at, *beside);
  }
  state->octree.compact();
  alone.compact();
  MesherCase out = case_over(state, alone.byte_size());
  out.mesh = [state, &volume, &visibility](PhaseTimes& phases) {
    const CulledPhases spent = mesh_culled(state->octree, {}, volume.scene.chunk.extent, visibility,
                                           now_ns, state->grid, state->quads);
    phases[static_cast<std::size_t>(Phase::octree)] += spent.octree;
  };
  return out;
}

MesherCase rle_rdm(const Volume& volume, const VisibilityTable& visibility) {
  struct State {
    RunChunk chunk;
    std::vector<Quad> quads;
  };
  auto state = std::make_shared<State>(State{reorder(volume.scene.chunk, AxisOrder::zyx), {}});
  MesherCase out = case_over(state, state->chunk.runs.byte_size());
  out.mesh = [state, &visibility](PhaseTimes&) {
    mesh_rle_rdm(state->chunk, visibility, state->quads);
  };
  return out;
}

MesherCase of_name(std::string_view name, const Volume& volume, const VisibilityTable& visibility) {
  if (name.starts_with("rdm")) return rdm(name, volume, visibility);
  if (name.ends_with("_binary")) return binary(name, volume, visibility);
  if (name == "culled") return culled(volume, visibility);
  if (name == "rle_rdm") return rle_rdm(volume, visibility);
  return grid_mesher_case(name, volume, visibility);
}

}  // namespace

std::span<const std::string_view> mesher_case_names() { return kNames; }

std::optional<MesherCase> make_mesher_case(std::string_view name, const Volume& volume,
                                           const VisibilityTable& visibility) {
  const auto known = std::find(kNames.begin(), kNames.end(), name);
  RUNSTONE_ASSERT(known != kNames.end());
  if (name.ends_with("_binary") && volume.edge > kBinarySideMax) return std::nullopt;
  if (name == "padded_binary" && volume.edge > kPaddedSideMax) return std::nullopt;
  MesherCase out = of_name(name, volume, visibility);
  out.name = *known;
  return out;
}

}  // namespace runstone::bench
