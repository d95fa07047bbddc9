// A scenario of the thesis as scenes to mesh, and the thesis' numbers of it.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "common/generate/generator.hpp"
#include "tests/reference/material_octree.hpp"
#include "tests/support/mesh/mesh_scene.hpp"

namespace runstone::test {

/// Returns scenario 1 .. 37 as the thesis' 3 x 3 x 3 chunks. Scenario 5 is the thesis' data and has
/// edge 32 only.
std::unique_ptr<Generator> scenario_generator(unsigned number, unsigned edge);

/// The step from one scenario to the next in tests of edges 64 and 128. With a sanitizer all of
/// them would take minutes.
#ifdef RUNSTONE_SANITIZED
inline constexpr unsigned kLargeScenarioStep = 12;
#else
inline constexpr unsigned kLargeScenarioStep = 1;
#endif

/// All solid types of the thesis are opaque.
const VisibilityTable& scenario_visibility();

/// Returns one chunk of such a world in its cheapest axis order, alone or with those of its six
/// neighbours that are among the 27 chunks.
MeshScene scenario_scene(const Generator& world, ChunkCoord at, unsigned edge, bool alone);

/// Returns all 27 chunks as Voxel Plugin would store them.
reference::MaterialOctree scenario_octree(const Generator& world, unsigned edge);

/// The thesis' counts of one chunk.
struct ScenarioNumbers {
  std::uint32_t opaque_voxels = 0;
  std::uint32_t runs = 0;           // in its index order, our zyx
  std::size_t vertices_culled = 0;  // 4 a quad, like all below
  std::size_t vertices_grid = 0;
  std::size_t vertices_rle = 0;
};
ScenarioNumbers numbers_of(const MeshScene& scene);

/// Returns the vertices of the culled mesher over samples of an octree.
std::size_t vertices_from_octree(const reference::MaterialOctree& octree, ChunkCoord at,
                                 unsigned edge);

/// Returns the bytes of run storage that the thesis logs: 12 for each run for which its array has
/// room. The array starts with room for as many runs as the chunk has solid materials, and grows to
/// m + floor(3 m / 8) + 16 when run m does not fit.
std::uint32_t rle_bytes_logged(const MeshScene& scene);

}  // namespace runstone::test
