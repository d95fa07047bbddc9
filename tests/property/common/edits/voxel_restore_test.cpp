#include "common/edits/restore/voxel_restore.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "common/edits/restore/restore.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

LocalPos local_to(VoxelPos origin, VoxelPos at) {
  return {static_cast<std::uint8_t>(at.x - origin.x), static_cast<std::uint8_t>(at.y - origin.y),
          static_cast<std::uint8_t>(at.z - origin.z)};
}

/// Returns some voxels of the chunk, ascending: all of them, few, or one.
std::vector<VoxelPos> some_voxels(SplitMix64& rng, VoxelPos origin, Extent extent) {
  const std::uint32_t one_in = std::vector<std::uint32_t>{1, 9, 200, 4000}[rng.below(4)];
  std::vector<VoxelPos> out;
  for (std::int32_t x = 0; x < extent.x; ++x) {
    for (std::int32_t y = 0; y < extent.y; ++y) {
      for (std::int32_t z = 0; z < extent.z; ++z) {
        if (rng.below(one_in) == 0) out.push_back({origin.x + x, origin.y + y, origin.z + z});
      }
    }
  }
  return out;
}

/// Both restores of one chunk.
struct Pair {
  ChunkRestore chunk;
  VoxelRestore voxels;
  struct Point {
    ChunkRestore::Point chunk;
    VoxelRestore::Point voxels;
  };
};

std::vector<Material> materials_at(const RunChunk& chunk, VoxelPos origin,
                                   const std::vector<VoxelPos>& voxels) {
  std::vector<Material> out;
  for (const VoxelPos& at : voxels) out.push_back(material_at(chunk, local_to(origin, at)));
  return out;
}

}  // namespace

TEST_CASE("voxels are restored as their chunk is", "[edits][restore][property]") {
  SplitMix64 rng{51 + Catch::rngSeed()};
  ApplyScratch scratch;
  std::size_t with_differences = 0, returned = 0;
  for (int round = 0; round < 400; ++round) {
    const RunChunk start = random_chunk(rng, 16, 6);
    const VoxelPos origin = {rng.between(-40, 40), rng.between(-40, 40), rng.between(-40, 40)};
    const std::vector<VoxelPos> voxels = some_voxels(rng, origin, start.extent);
    Pair restore{ChunkRestore(start, origin),
                 VoxelRestore(voxels, materials_at(start, origin, voxels))};
    std::vector<Pair::Point> points;
    const std::uint64_t selected_of_ten = 1 + rng.below(9);
    const std::size_t count = 1 + rng.below(round % 8 == 0 ? 120 : 24);
    CAPTURE(Catch::rngSeed(), round, count, selected_of_ten, voxels.size());
    for (std::size_t i = 0; i < count; ++i) {
      const EditDescriptor edit = random_edit_near(rng, origin, start.extent);
      const bool is_selected = rng.below(10) < selected_of_ten;
      if (rng.below(5) == 0)
        points.push_back({restore.chunk.point(scratch), restore.voxels.point(scratch)});
      if (!is_selected && !points.empty() && rng.below(3) == 0) {
        const auto& point = points[rng.below(static_cast<std::uint32_t>(points.size()))];
        restore.chunk.add_return(edit, point.chunk, scratch);
        restore.voxels.add_return(edit, point.voxels, scratch);
        ++returned;
      } else {
        restore.chunk.add(edit, is_selected, scratch);
        restore.voxels.add(edit, is_selected, scratch);
      }
    }
    restore.chunk.flush(scratch);
    const auto now = materials_at(restore.chunk.now(), origin, voxels);
    const auto restored = materials_at(restore.chunk.restored(), origin, voxels);
    REQUIRE(std::equal(now.begin(), now.end(), restore.voxels.now().begin(),
                       restore.voxels.now().end()));
    REQUIRE(std::equal(restored.begin(), restored.end(), restore.voxels.restored().begin(),
                       restore.voxels.restored().end()));
    std::uint64_t differences = 0;
    for (std::size_t i = 0; i < now.size(); ++i) differences += now[i] != restored[i] ? 1 : 0;
    REQUIRE(restore.voxels.differences() == differences);
    with_differences += differences > 0 ? 1 : 0;
  }
  CHECK(with_differences > 150);
  CHECK(returned > 200);
}

TEST_CASE("an edit without voxels restores none", "[edits][restore]") {
  ApplyScratch scratch;
  VoxelRestore restore({{-kWorldLimit, -kWorldLimit, -kWorldLimit}, {0, 0, 0}}, {3, 4});
  restore.add(materials_edit({}), true, scratch);
  restore.add({SetVoxel{{0, 0, 0}}, {}, 5}, true, scratch);
  CHECK(restore.differences() == 1);
  CHECK(restore.now()[1] == 5);
  CHECK(restore.restored()[1] == 4);
}

}  // namespace runstone::test
