#include "tests/support/scenarios/scenario_scene.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <set>
#include <span>

#include "common/generate/columns_world.hpp"
#include "common/generate/scenarios/scenario_world.hpp"
#include "common/runs/reorder.hpp"
#include "tests/reference/culled_mesher.hpp"
#include "tests/reference/grid_rdm.hpp"
#include "tests/reference/rle_rdm.hpp"
#include "tests/support/scenarios/thesis_table.hpp"

namespace runstone::test {
namespace {

bool in_world(ChunkCoord c) {
  return std::min({c.x, c.y, c.z}) >= -1 && std::max({c.x, c.y, c.z}) <= 1;
}

RunChunk chunk_at(const Generator& world, ChunkCoord at, unsigned edge) {
  return in_cheapest_order(
      world.generate(origin_of(at, static_cast<std::int32_t>(edge)), Extent::cube(edge)));
}

}  // namespace

std::unique_ptr<Generator> scenario_generator(unsigned number, unsigned edge) {
  if (number == 5) {
    if (edge != 32) std::abort();
    auto columns = ColumnsWorld::parse(thesis_text("scenario5_columns.csv"));
    if (!columns) std::abort();
    return std::move(*columns);
  }
  const auto model = scenario_model(number, edge);
  if (!model) std::abort();
  return std::make_unique<ScenarioWorld>(*model, kStone);
}

const VisibilityTable& scenario_visibility() {
  // Every id is opaque: the table has no entry.
  static const VisibilityTable table(std::span<const Visibility>{});
  return table;
}

MeshScene scenario_scene(const Generator& world, ChunkCoord at, unsigned edge, bool alone) {
  MeshScene scene{chunk_at(world, at, edge), {}};
  for (unsigned d = 0; d < kDirectionCount; ++d) {
    const ChunkCoord beside = neighbour(at, static_cast<Direction>(d));
    if (!alone && in_world(beside)) scene.neighbours[d] = chunk_at(world, beside, edge);
  }
  return scene;
}

reference::MaterialOctree scenario_octree(const Generator& world, unsigned edge) {
  const auto side = static_cast<std::int32_t>(edge);
  const auto bricks = static_cast<unsigned>(3 * side / reference::MaterialOctree::kBrickSide);
  reference::MaterialOctree octree({-side, -side, -side},
                                   static_cast<unsigned>(std::bit_width(bricks)));
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x)
        octree.insert(origin_of({x, y, z}, side), chunk_at(world, {x, y, z}, edge));
    }
  }
  octree.compact();
  return octree;
}

ScenarioNumbers numbers_of(const MeshScene& scene) {
  ScenarioNumbers out;
  const RunChunk thesis_order = reorder(scene.chunk, AxisOrder::zyx);
  out.runs = static_cast<std::uint32_t>(thesis_order.runs.size());
  for (std::size_t i = 0; i < thesis_order.runs.size(); ++i) {
    if (thesis_order.runs.material(i) != kEmpty) {
      out.opaque_voxels += thesis_order.runs.end(i) - thesis_order.runs.begin(i);
    }
  }
  const reference::DenseGrid grid = grid_of(scene);
  std::vector<Quad> quads;
  reference::mesh_culled(grid, scenario_visibility(), quads);
  out.vertices_culled = 4 * quads.size();
  reference::GridRdmScratch scratch;
  reference::mesh_grid_rdm(grid, scenario_visibility(), scratch, quads);
  out.vertices_grid = 4 * quads.size();
  reference::mesh_rle_rdm(thesis_order, scenario_visibility(), quads);
  out.vertices_rle = 4 * quads.size();
  return out;
}

std::size_t vertices_from_octree(const reference::MaterialOctree& octree, ChunkCoord at,
                                 unsigned edge) {
  reference::DenseGrid grid;
  std::vector<Quad> quads;
  constexpr auto kNoTime = [] { return std::uint64_t{0}; };
  reference::mesh_culled(octree, origin_of(at, static_cast<std::int32_t>(edge)), Extent::cube(edge),
                         scenario_visibility(), kNoTime, grid, quads);
  return 4 * quads.size();
}

std::uint32_t rle_bytes_logged(const MeshScene& scene) {
  const RunChunk chunk = reorder(scene.chunk, AxisOrder::zyx);
  std::set<Material> solid;
  for (std::size_t i = 0; i < chunk.runs.size(); ++i) solid.insert(chunk.runs.material(i));
  solid.erase(kEmpty);
  auto room = static_cast<std::uint32_t>(solid.size());
  for (std::uint32_t run = 1; run <= chunk.runs.size(); ++run) {
    if (run > room) room = run + 3 * run / 8 + 16;
  }
  return 12 * room;
}

}  // namespace runstone::test
