#include "bench/view/view_pane.hpp"

#include <array>
#include <functional>
#include <utility>

#include "bench/harness/clocks.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/meshing/mesher_case.hpp"
#include "bench/view/quad_layers.hpp"
#include "common/core/assert.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
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
  const char *short_name, *name, *timed;
  ChunkMesher (*make)(const FramesChunk&, const VisibilityTable&);
};
constexpr std::array<PaneMesher, 3> kMeshers = {
    {{"culled", "culled faces", "decode + mesh", &culled_mesher},
     {"binary", "binary greedy", "decode + mask + mesh", &binary_mesher},
     {"rdm", "RDM", "mesh, from stored runs", &rdm_mesher}}};

}  // namespace

std::vector<std::string> view_mesher_names() {
  std::vector<std::string> out;
  out.reserve(kMeshers.size());
  for (const PaneMesher& mesher : kMeshers) out.emplace_back(mesher.short_name);
  return out;
}

std::vector<ViewPane> view_panes(const FramesWorld& world, unsigned repetitions,
                                 std::string_view only) {
  std::vector<PaneMesher> wanted(kMeshers.begin(), kMeshers.end());
  std::erase_if(wanted, [only](const PaneMesher& mesher) {
    return !only.empty() && mesher.short_name != only;
  });
  std::vector<std::vector<ChunkMesher>> meshers(wanted.size());
  for (std::size_t m = 0; m < wanted.size(); ++m) {
    for (const FramesChunk& chunk : world.chunks) {
      meshers[m].push_back(wanted[m].make(chunk, *world.visibility));
      meshers[m].back().mesh();  // touches its memory
    }
  }
  std::vector<std::vector<double>> us(wanted.size());
  for (unsigned i = 0; i < repetitions; ++i) {
    for (std::size_t m = 0; m < wanted.size(); ++m) {
      const std::uint64_t start = core_ns();
      for (const ChunkMesher& mesher : meshers[m]) mesher.mesh();
      us[m].push_back(static_cast<double>(core_ns() - start) * 1e-3);
    }
  }
  std::vector<ViewPane> out;
  for (std::size_t m = 0; m < wanted.size(); ++m) {
    ViewPane pane;
    pane.name = wanted[m].name;
    pane.timed = wanted[m].timed;
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
