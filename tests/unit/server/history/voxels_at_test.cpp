// The array of a box has the material of each voxel that the chunks of the world have.
#include "server/history/voxels_at.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "common/runs/dense.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

TEST_CASE("an array of a box has the voxels of the world at each moment, by any number of readers",
          "[server][history]") {
  const TempFolder folder;
  SplitMix64 rng(41);
  WorldMeta meta = sample_meta();
  meta.generator = {"terrain", 1, 5, ""};
  {
    auto store = create_world(folder.path(), meta);
    REQUIRE(store.has_value());
    REQUIRE((*store)->raise_epoch().has_value());
    const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
    REQUIRE((*store)->append(players, sample_records(rng, 1, 1, 60)).has_value());
  }
  const auto generator = make_generator(meta.generator, meta.materials);
  REQUIRE(generator.has_value());
  std::vector<std::unique_ptr<Store>> opened;
  std::vector<WorldReader*> readers;
  for (int i = 0; i < 3; ++i) {
    auto store = open_world(folder.path(), StoreAccess::read_only);
    REQUIRE(store.has_value());
    opened.push_back(*std::move(store));
    readers.push_back(opened.back().get());
  }
  // The first box has whole chunks and parts of chunks on both sides of the origin; the second one
  // is a single voxel; the last one is empty air.
  const std::vector<VoxelBox> boxes = {
      {{-37, -21, -18}, {43, 40, 35}}, {{-1, 3, 7}, {0, 4, 8}}, {{0, 4096, 0}, {16, 4112, 40}}};
  for (const Sequence at : {Sequence{0}, Sequence{31}, Sequence{60}}) {
    auto world = WorldAt::open(*readers.front(), **generator, at);
    REQUIRE(world.has_value());
    std::map<ChunkCoord, RunChunk> chunks;
    const auto chunk_at = [&](ChunkCoord coord) -> const RunChunk& {
      if (!chunks.contains(coord)) {
        const auto made = world->chunk({0, coord});
        REQUIRE(made.has_value());
        chunks[coord] = made->voxels;
      }
      return chunks[coord];
    };
    for (const VoxelBox& box : boxes) {
      for (std::size_t count = 1; count <= readers.size(); ++count) {
        const auto side = [](std::int32_t min, std::int32_t max) {
          return static_cast<std::size_t>(max - min);
        };
        std::vector<Material> out(
            side(box.min.x, box.max.x) * side(box.min.y, box.max.y) * side(box.min.z, box.max.z),
            0xffff);
        const std::uint64_t before = dense_expansions();
        REQUIRE(read_voxels(*world, std::span(readers).first(count), box, out).has_value());
        CHECK(dense_expansions() == before + 1);
        std::size_t index = 0, wrong = 0;
        for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
          for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
            for (std::int32_t z = box.min.z; z < box.max.z; ++z, ++index) {
              const VoxelPos voxel{x, y, z};
              const RunChunk& chunk = chunk_at(chunk_of(voxel, kSampleEdge));
              if (material_at(chunk, local_of(voxel, kSampleEdge)) != out[index]) ++wrong;
            }
          }
        }
        CAPTURE(at, count);
        CHECK(wrong == 0);
      }
    }
  }
}
