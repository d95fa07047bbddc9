// Tiles of a world under edits, saves and restarts are compared with tiles that the dense oracle
// builds of all chunks.
#include "server/tiles/tile_source.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "common/runs/run_builder.hpp"
#include "common/tiles/tile_rules.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/tiles/tile_oracle.hpp"
#include "tests/unit/server/tiles/tile_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

RunChunk runs_of(const DenseChunk& dense, AxisOrder order) {
  RunBuilder out(dense.extent(), order);
  for (std::uint32_t i = 0; i < dense.extent().volume(); ++i) {
    const VoxelPos at = dense_pos(dense.extent(), order, i);
    out.append(1, dense.at(at.x, at.y, at.z));
  }
  return out.finish();
}

/// Builds the tile of all chunks below it, through all levels.
Chunk expected(const TileWorld& world, const ChunkKey& key) {
  if (key.lod == 0) return *world.chunk(key.at);
  std::array<Chunk, 8> below;
  Children children{};
  Chunk out;
  for (unsigned i = 0; i < 8; ++i) {
    below[i] = expected(world, tile_child(key, i));
    children[i] = &below[i].voxels;
    out.version = std::max(out.version, below[i].version);
  }
  const DenseChunk tile = expected_tile(children, kSampleEdge, default_material_table());
  out.voxels = runs_of(tile, kTileOrder);
  return out;
}

/// Returns true if the last made tile is the expected one.
bool is_expected(const TileWorld& world, const std::vector<MadeTile>& made, const ChunkKey& key) {
  const Chunk tile = expected(world, key);
  const DenseChunk voxels = DenseChunk::of(tile.voxels);
  const DenseChunk veiled = expected_veil(voxels, kTileOrder, default_material_table());
  const MadeTile& found = made.back();
  const Chunk& sent = *found.for_clients();
  return found.key == key && found.tile->version == tile.version && found.through >= world.head &&
         DenseChunk::of(found.tile->voxels) == voxels &&
         found.tile->digest == digest_of(tile.voxels) && sent.version == tile.version &&
         DenseChunk::of(sent.voxels) == veiled && sent.digest == digest_of(sent.voxels);
}

void edit_and_compare(TileWorld& world, std::uint8_t level_max, int steps) {
  SplitMix64& random = world.random;
  const auto chunk_near = [&]() -> ChunkCoord {
    return {random.between(-3, 2), random.between(-2, 1), random.between(-3, 2)};
  };
  std::vector<std::vector<MadeTile>> not_saved;
  for (int step = 0; step < steps; ++step) {
    CAPTURE(Catch::rngSeed(), step);
    switch (random.below(10)) {
      case 0:
        world.save_all();
        break;
      case 1:
        if (!world.unsaved.empty()) world.save({*world.unsaved.begin()});
        break;
      case 2:  // the tiles may be older than snapshots that were saved since
        for (const auto& made : not_saved) world.save_tiles(made);
        not_saved.clear();
        break;
      case 3:
        if (random.below(4) == 0) {
          world.start();
          not_saved.clear();  // they are lost
        }
        break;
      case 4:
      case 5:
      case 6: {
        std::vector<ChunkCoord> touched = {chunk_near()};
        for (std::uint32_t i = random.below(3); i > 0; --i) touched.push_back(chunk_near());
        std::sort(touched.begin(), touched.end());
        touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
        world.edit(touched);
        break;
      }
      default: {
        const std::uint8_t level =
            random.below(9) == 0 ? level_max
                                 : static_cast<std::uint8_t>(1 + random.below(level_max - 1U));
        const ChunkKey key = tile_of(chunk_near(), level);
        CAPTURE(key.lod, key.at.x, key.at.y, key.at.z);
        const auto made = world.make(key);
        REQUIRE(is_expected(world, made, key));
        not_saved.push_back(made);
        break;
      }
    }
  }
  CHECK(world.warnings.empty());
  // A server that starts after a stop finds the tiles that are still right. Some of those that are
  // saved late are not.
  not_saved.push_back(world.make(tile_of({0, 0, 0}, 2)));
  world.edit({{0, 0, 0}});
  world.save_all();
  for (const auto& made : not_saved) world.save_tiles(made);
  world.start();
  const auto stored = *world.store->tile_keys(kTileRules);
  CHECK_FALSE(stored.empty());
  for (const auto& [key, version] : stored) {
    CAPTURE(key.lod, key.at.x, key.at.y, key.at.z);
    const auto made = world.make(key);
    REQUIRE(made.back().is_known);
    REQUIRE(is_expected(world, made, key));
  }
}

}  // namespace

TEST_CASE("tiles of edited worlds equal those that the oracle builds of all chunks",
          "[tiles][property]") {
  SECTION("empty") {
    TileWorld world({"empty", 1, 0, ""}, Catch::rngSeed());
    edit_and_compare(world, 4, 100);
  }
  SECTION("bounded") {
    TileWorld world({"scenario", 1, 0, "number = 10\nedge = 32"}, Catch::rngSeed() + 1);
    edit_and_compare(world, 3, 120);
  }
  SECTION("terrain") {  // its coarse form is not exact
    TileWorld world({"terrain", 1, 7, ""}, Catch::rngSeed() + 2);
    edit_and_compare(world, 2, 120);
  }
}
