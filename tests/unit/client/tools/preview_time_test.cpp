// Measurements that a person starts: unit_client_tools "[.time]". They print microseconds of processor
// time of the thread, and check no bound, because another machine has other times.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "client/replica/copy_box.hpp"
#include "client/tools/edit_preview.hpp"
#include "common/builds/paste_source.hpp"
#include "common/generate/generator.hpp"
#include "common/materials/material_table.hpp"
#include "common/os/thread_cpu_ns.hpp"
#include "common/runs/reorder.hpp"
#include "tests/support/codec/chunks_message.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kMeasuredEdge = 32;
constexpr int kMoves = 600;
/// The chunks of the scene: x and z from -4, y around the surface.
constexpr std::int32_t kReach = 4;

void show_terrain(Replica& replica) {
  replica.set_view({1, {0, 0, 0}, 5, 5});
  static_cast<void>(replica.open({kMeasuredEdge, 5, 77, 3, 0, 0, 0}));
  const auto made = make_generator({"terrain", 1, 7, ""}, default_material_table());
  REQUIRE(made);
  for (std::int32_t x = -kReach; x < kReach; ++x) {
    for (std::int32_t y = -kReach; y < kReach; ++y) {
      for (std::int32_t z = -kReach; z < kReach; ++z) {
        ChunkSnapshot snapshot;
        snapshot.key = {0, {x, y, z}};
        snapshot.chunk.voxels = in_cheapest_order(
            (*made)->generate(origin_of({x, y, z}, kMeasuredEdge), Extent::cube(kMeasuredEdge)));
        snapshot.chunk.digest = digest_of(snapshot.chunk.voxels);
        replica.receive(chunks_of(std::move(snapshot)), {1000, 1100, 1200});
      }
    }
  }
}

void print_times(const std::string& name, std::vector<double> us) {
  std::sort(us.begin(), us.end());
  const auto at = [&](double share) {
    return us[static_cast<std::size_t>(share * static_cast<double>(us.size() - 1))];
  };
  std::printf("%-44s p50 %7.0f us  p99 %7.0f us  max %7.0f us\n", name.c_str(), at(0.5), at(0.99),
              us.back());
}

/// Prints the times of the previews of edits that move by a voxel at a time.
void measure(const std::string& name, const Replica& replica,
             const std::function<EditDescriptor(VoxelPos)>& edit_at) {
  const std::vector<Visibility> visible = visibilities(default_material_table());
  EditPreview preview;
  preview.set_materials(std::make_shared<const MeshMaterials>(VisibilityTable(visible)));
  std::vector<double> us;
  for (int i = 0; i < kMoves; ++i) {
    const VoxelPos at{i % 37 - 50, -20 + i % 11, i % 41 - 50};
    std::vector<EditDescriptor> edits = {edit_at(at)};
    const std::int64_t begun_ns = thread_cpu_ns();
    preview.set(std::move(edits));
    static_cast<void>(preview.step(replica, 10'000));
    us.push_back(static_cast<double>(thread_cpu_ns() - begun_ns) / 1e3);
  }
  REQUIRE(preview.placed_voxels() > 0);
  print_times(name, std::move(us));
}

}  // namespace

TEST_CASE("the time of a preview after the aim moved by a voxel", "[.time]") {
  Replica replica;
  show_terrain(replica);
  const auto copied = copy_box(replica, {{-60, -32, -60}, {4, 32, 4}});
  REQUIRE(copied);
  const auto hill = whole_clipboard(**copied, EmptyCells::skipped, {});
  const auto block = whole_clipboard(**copied, EmptyCells::pasted, {});
  REQUIRE(hill);
  REQUIRE(block);
  std::printf("clipboards of 64 voxels a side: %zu and %zu runs\n", hill->cells().runs.size(),
              block->cells().runs.size());
  measure("paste 64^3 of terrain, without its air", replica,
          [&](VoxelPos at) { return EditDescriptor{Paste{at, hill, {}}, {}, kEmpty}; });
  measure("paste 64^3 of terrain, with its air", replica,
          [&](VoxelPos at) { return EditDescriptor{Paste{at, block, {}}, {}, kEmpty}; });
  measure("paste 64^3 of terrain, turned by a quarter", replica, [&](VoxelPos at) {
    return EditDescriptor{Paste{at, hill, Orientation{}.rotated_about_y(1)}, {}, kEmpty};
  });
  measure("sphere of radius 32", replica, [](VoxelPos at) {
    return EditDescriptor{FillSphere{{at.x + 32, at.y + 32, at.z + 32}, 32}, {}, 2};
  });
  measure("box of 64^3", replica, [](VoxelPos at) {
    return EditDescriptor{FillBox{{at, {at.x + 64, at.y + 64, at.z + 64}}}, {}, 2};
  });
  measure("voxel", replica,
          [](VoxelPos at) { return EditDescriptor{SetVoxel{{at.x, at.y + 60, at.z}}, {}, 2}; });
}

}  // namespace runstone::test
