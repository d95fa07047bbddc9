// Volumes cut from a world with bounds, and edits timed on them.
#include "bench/worlds/voxel_world.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "bench/edits/edit_case.hpp"
#include "bench/worlds/seeded_worlds.hpp"

using namespace runstone;
using namespace runstone::bench;

namespace {

Material material_of(VoxelPos at) {
  return static_cast<Material>(1 + (at.x * 7 + at.y * 5 + at.z * 3) % 3);
}

VoxelWorld bounded_world(const VoxelBox& bounds) {
  VoxelWorld out;
  out.name = "bounded";
  out.visibility = std::make_shared<const VisibilityTable>(visibilities(seeded_materials()));
  out.bounds = bounds;
  out.column = [bounds](VoxelPos at, std::span<Material> to) {
    REQUIRE(bounds.contains(at));
    REQUIRE(at.y + static_cast<std::int32_t>(to.size()) <= bounds.max.y);
    for (Material& material : to) {
      material = material_of(at);
      ++at.y;
    }
  };
  return out;
}

}  // namespace

TEST_CASE("volumes cover their world to its upper corner", "[bench]") {
  const VoxelBox bounds{{5, 0, 2}, {5 + 40, 16, 2 + 33}};
  const std::vector<Volume> volumes = volumes_of(bounded_world(bounds), 16);
  REQUIRE(volumes.size() == 3 * 1 * 3);
  std::set<VoxelPos> covered;
  for (const Volume& volume : volumes) {
    CAPTURE(volume.origin.x, volume.origin.y, volume.origin.z);
    bool right = true;
    for (std::uint8_t z = 0; z < 16; ++z) {
      for (std::uint8_t y = 0; y < 16; ++y) {
        for (std::uint8_t x = 0; x < 16; ++x) {
          const VoxelPos at{volume.origin.x + x, volume.origin.y + y, volume.origin.z + z};
          right &=
              bounds.contains(at) && material_at(volume.scene.chunk, {x, y, z}) == material_of(at);
          covered.insert(at);
        }
      }
    }
    CHECK(right);
  }
  CHECK(covered.size() == 40 * 16 * 33);
  CHECK(volumes_of(bounded_world(bounds), 17).empty());
}

TEST_CASE("a neighbour that is known in part is empty beyond the bounds", "[bench]") {
  const VoxelBox bounds{{0, 0, 0}, {40, 16, 16}};
  const Volume volume = cut_volume(bounded_world(bounds), {16, 0, 0}, 16);
  const auto& beyond = volume.scene.neighbours[static_cast<std::size_t>(Direction::pos_x)];
  REQUIRE(beyond.has_value());
  CHECK(material_at(*beyond, {7, 3, 3}) == material_of({39, 3, 3}));
  CHECK(material_at(*beyond, {8, 3, 3}) == kEmpty);
  CHECK_FALSE(volume.scene.neighbours[static_cast<std::size_t>(Direction::pos_y)].has_value());
}

TEST_CASE("edits are timed with the neighbours whose border they lie at", "[bench]") {
  // Each edit aborts if remeshing differs from a full mesh.
  const VoxelWorld world = seeded_worlds().front();
  const EditTiming edits = measure_edits(world, volumes_of(world, 16), 100, 1);
  CHECK(edits.edits == 100);
  CHECK(edits.at_borders > 10);
  CHECK(edits.at_borders < 75);
  CHECK(edits.all_ns >= edits.chunk_ns);
  // A world of one volume has no neighbours.
  const VoxelWorld alone = bounded_world({{0, 0, 0}, {16, 16, 16}});
  CHECK(measure_edits(alone, volumes_of(alone, 16), 20, 1).at_borders == 0);
}
