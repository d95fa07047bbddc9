#include "tests/bench/view/view_pane.hpp"

#include <array>
#include <functional>
#include <utility>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "tests/bench/harness/clocks.hpp"
#include "tests/bench/harness/statistics.hpp"
#include "tests/bench/meshing/mesher_case.hpp"
#include "tests/bench/view/quad_layers.hpp"
#include "tests/reference/culled_mesher.hpp"
#include "tests/reference/dense_grid.hpp"

namespace runstone::bench {
namespace {

/// A mesher with its buffers for one chunk.
struct ChunkMesher {
  std::function<void()> mesh;
  std::function<ChunkMesh()> result;
};

ChunkMesher culled_mesher(const FramesChunk& chunk, const VisibilityTable& visibility) {
  struct Buffers {
    reference::DenseGrid grid;
    std::vector<Material> layer;
    std::vector<Quad> quads;
  };
  const auto buffers = std::make_shared<Buffers>();
  return {[buffers, &chunk, &visibility] {
            buffers->quads.clear();
            reference::decode(chunk.volume.scene.chunk, chunk.volume.scene.pointers(),
                              buffers->layer, buffers->grid);
            reference::mesh_culled(buffers->grid, visibility, buffers->quads);
          },
          [buffers, &visibility] { return layered(buffers->quads, visibility); }};
}

ChunkMesher binary_mesher(const FramesChunk& chunk, const VisibilityTable& visibility) {
  auto made = make_mesher_case("decode_binary", chunk.volume, visibility);
  RUNSTONE_ASSERT(made);
  const auto mesher = std::make_shared<MesherCase>(*std::move(made));
  return {[mesher] {
            PhaseTimes phases{};
            mesher->mesh(phases);
          },
          [mesher, &visibility] {
            reference::Surface surface;
            mesher->surface(surface);
            return layered(surface.quads, visibility);
          }};
}

ChunkMesher rdm_mesher(const FramesChunk& chunk, const VisibilityTable& visibility) {
  struct Buffers {
    RdmScratch scratch;
    ChunkMesh mesh;
  };
  const auto buffers = std::make_shared<Buffers>();
  return {[buffers, &chunk, &visibility] {
            mesh_rdm(chunk.volume.scene.chunk, chunk.volume.scene.pointers(), {}, visibility,
                     buffers->scratch, buffers->mesh);
          },
          [buffers] { return buffers->mesh; }};
}

struct PaneMesher {
  const char *name, *timed;
  ChunkMesher (*make)(const FramesChunk&, const VisibilityTable&);
};
constexpr std::array<PaneMesher, 3> kMeshers = {
    {{"culled faces", "decode + mesh", &culled_mesher},
     {"binary greedy", "decode + mask + mesh", &binary_mesher},
     {"RDM", "mesh, from stored runs", &rdm_mesher}}};

}  // namespace

std::vector<ViewPane> view_panes(const FramesWorld& world, unsigned repetitions) {
  std::vector<std::vector<ChunkMesher>> meshers(kMeshers.size());
  for (std::size_t m = 0; m < kMeshers.size(); ++m) {
    for (const FramesChunk& chunk : world.chunks) {
      meshers[m].push_back(kMeshers[m].make(chunk, *world.visibility));
      meshers[m].back().mesh();  // touches its memory
    }
  }
  std::vector<std::vector<double>> us(kMeshers.size());
  for (unsigned i = 0; i < repetitions; ++i) {
    for (std::size_t m = 0; m < kMeshers.size(); ++m) {
      const std::uint64_t start = core_ns();
      for (const ChunkMesher& mesher : meshers[m]) mesher.mesh();
      us[m].push_back(static_cast<double>(core_ns() - start) * 1e-3);
    }
  }
  std::vector<ViewPane> out;
  for (std::size_t m = 0; m < kMeshers.size(); ++m) {
    ViewPane pane;
    pane.name = kMeshers[m].name;
    pane.timed = kMeshers[m].timed;
    pane.mesh_us = median(us[m]);
    for (std::size_t c = 0; c < world.chunks.size(); ++c) {
      pane.chunks.push_back({world.chunks[c].at, meshers[m][c].result()});
      pane.quads += pane.chunks.back().mesh.quad_count();
    }
    out.push_back(std::move(pane));
  }
  return out;
}

}  // namespace runstone::bench
