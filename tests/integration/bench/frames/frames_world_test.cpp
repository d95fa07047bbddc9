// The drawn blocks of chunks, in which chunks know each other and nothing else.
#include "bench/frames/frames_world.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "bench/worlds/seeded_worlds.hpp"

using namespace runstone;
using namespace runstone::bench;

namespace {

/// Checks that each neighbour is the chunk that lies there, and is missing only where the block
/// ends.
void check_neighbours(const FramesWorld& world) {
  CHECK(world.chunks.size() ==
        static_cast<std::size_t>(world.size[0] * world.size[1] * world.size[2]));
  for (const FramesChunk& chunk : world.chunks) {
    CHECK(chunk.volume.edge == world.edge);
    for (unsigned d = 0; d < kDirectionCount; ++d) {
      const ChunkCoord beside = neighbour(chunk.at, static_cast<Direction>(d));
      const auto there = std::find_if(world.chunks.begin(), world.chunks.end(),
                                      [&](const FramesChunk& other) { return other.at == beside; });
      const auto& known = chunk.volume.scene.neighbours[d];
      REQUIRE(known.has_value() == (there != world.chunks.end()));
      if (known) CHECK(known->runs == there->volume.scene.chunk.runs);
    }
  }
}

}  // namespace

TEST_CASE("a block is cut from a world at the given place", "[frames]") {
  const auto worlds = seeded_worlds();
  const auto hills = std::find_if(worlds.begin(), worlds.end(),
                                  [](const VoxelWorld& w) { return w.name == "hills"; });
  REQUIRE(hills != worlds.end());
  const FramesWorld block = block_of(*hills, {-16, -8, 40}, {3, 1, 2}, 8);
  check_neighbours(block);
  for (const FramesChunk& chunk : block.chunks) {
    const VoxelPos at = {-16 + 8 * chunk.at.x, -8 + 8 * chunk.at.y, 40 + 8 * chunk.at.z};
    CHECK(chunk.volume.origin == at);
    CHECK(chunk.volume.scene.chunk.runs == chunk_of_world(*hills, at, 8).runs);
  }
}

TEST_CASE("every name is a world: 27 chunks a scenario, and the ground of the Luanti world",
          "[frames]") {
  const auto names = frames_world_names();
  REQUIRE(names.size() == 38);
  CHECK(names[4] == "scenario_5");
  for (const char* name : {"scenario_5", "scenario_37"}) {
    CAPTURE(name);
    const auto world = frames_world(name, "");
    REQUIRE(world.has_value());
    CHECK(world->name == name);
    CHECK(world->size == std::array<int, 3>{3, 3, 3});
    check_neighbours(*world);
  }
  const auto luanti = frames_world("luanti", RUNSTONE_SOURCE_DIR "/tests/data/luanti_v7_small");
  REQUIRE(luanti.has_value());
  check_neighbours(*luanti);
  // The ground has chunks of rock, of air, and of both.
  const auto uniform = [](const FramesChunk& chunk) {
    return chunk.volume.scene.chunk.is_uniform();
  };
  CHECK_FALSE(std::all_of(luanti->chunks.begin(), luanti->chunks.end(), uniform));
  const auto missing = frames_world("luanti", RUNSTONE_SOURCE_DIR "/tests/data/none");
  REQUIRE_FALSE(missing.has_value());
  CHECK(missing.error().find("none") != std::string::npos);
}
