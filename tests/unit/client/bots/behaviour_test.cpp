#include "client/bots/behaviour.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "tests/support/codec/chunks_message.hpp"

using namespace runstone;

namespace {

constexpr std::int32_t kEdge = 32;

/// Loads flat ground, solid for y < 0, for `radius` chunks around a site.
void load_flat_world(Replica& replica, ChunkCoord centre, std::uint8_t radius) {
  const View view{1, centre, radius, radius};
  replica.set_view(view);
  replica.open({.chunk_edge = kEdge, .author = 1, .instance = 1, .epoch = 1});
  for (std::int32_t x = centre.x - radius; x <= centre.x + radius; ++x) {
    for (std::int32_t y = centre.y - radius; y <= centre.y + radius; ++y) {
      for (std::int32_t z = centre.z - radius; z <= centre.z + radius; ++z) {
        if (!view.contains({x, y, z})) continue;
        ChunkSnapshot snapshot;
        snapshot.key = {0, {x, y, z}};
        snapshot.chunk.voxels = uniform_chunk(Extent::cube(kEdge), y < 0 ? Material{4} : kEmpty);
        snapshot.chunk.digest = digest_of(snapshot.chunk.voxels);
        replica.receive(test::chunks_of(std::move(snapshot)), {});
      }
    }
  }
}

std::vector<EditDescriptor> edits_of(BotRole role, const BotPlace& place, std::uint64_t seed,
                                     int count) {
  const VoxelPos corner = site_corner(place);
  Replica replica;
  load_flat_world(replica, chunk_of({corner.x + 24, 8, corner.z + 24}, kEdge), 3);
  const auto behaviour = make_behaviour(role, place, default_material_table(), seed);
  std::vector<EditDescriptor> out;
  for (int i = 0; i < count; ++i) {
    if (const auto edit = behaviour->next_edit(ReplicaGround(replica))) out.push_back(*edit);
  }
  return out;
}

}  // namespace

TEST_CASE("sites of a fleet do not touch", "[bots]") {
  for (const std::size_t count : {1U, 2U, 20U, 50U}) {
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = a + 1; b < count; ++b) {
        const VoxelPos first = site_corner({{0.5, 9, -3.5}, a, count});
        const VoxelPos second = site_corner({{0.5, 9, -3.5}, b, count});
        CHECK((std::abs(first.x - second.x) >= kSiteSide ||
               std::abs(first.z - second.z) >= kSiteSide));
      }
    }
  }
}

TEST_CASE("the same seed gives the same edits, and another seed other edits", "[bots]") {
  const BotPlace place{{0, 8, 0}, 0, 1};
  for (const BotRole role : {BotRole::build, BotRole::brush, BotRole::grief}) {
    const auto first = edits_of(role, place, 5, 300);
    REQUIRE(first.size() > 200);
    CHECK(first == edits_of(role, place, 5, 300));
    CHECK(first != edits_of(role, place, 6, 300));
    for (const EditDescriptor& edit : first) CHECK(validate(edit).has_value());
  }
}

TEST_CASE("builders and brushes stay on their site", "[bots]") {
  const BotPlace place{{0, 8, 0}, 2, 4};
  const VoxelPos corner = site_corner(place);
  for (const BotRole role : {BotRole::build, BotRole::brush}) {
    for (const EditDescriptor& edit : edits_of(role, place, 9, 6'000)) {
      const VoxelBox box = bounding_box(edit);
      CHECK(box.min.x >= corner.x);
      CHECK(box.min.z >= corner.z);
      CHECK(box.max.x <= corner.x + kSiteSide);
      CHECK(box.max.z <= corner.z + kSiteSide);
    }
  }
}

TEST_CASE("a builder waits until it sees its plot, and idlers and walkers edit nothing", "[bots]") {
  const BotPlace place{{0, 8, 0}, 0, 1};
  Replica far;
  load_flat_world(far, {40, 0, 40}, 1);
  CHECK_FALSE(make_behaviour(BotRole::build, place, default_material_table(), 1)
                  ->next_edit(ReplicaGround(far)));
  CHECK(edits_of(BotRole::idle, place, 1, 10).empty());
  CHECK(edits_of(BotRole::walk, place, 1, 10).empty());
}

TEST_CASE("a walker goes round its site at a steady speed", "[bots]") {
  const auto behaviour =
      make_behaviour(BotRole::walk, {{0, 8, 0}, 0, 1}, default_material_table(), 1);
  for (double t = 0; t < 60; t += 1) {
    const WorldPos a = behaviour->position(t), b = behaviour->position(t + 0.01);
    const double speed = std::hypot(b.x - a.x, b.z - a.z) / 0.01;
    CHECK(speed == Approx(4).epsilon(0.01));
  }
}

TEST_CASE("a bot that runs away never returns, and always sees new chunks", "[bots]") {
  const BotPlace place{{0, 8, 0}, 0, 1};
  const auto behaviour = make_behaviour(BotRole::run_away, place, default_material_table(), 3);
  const WorldPos from = behaviour->position(0);
  double way = -1;
  ChunkCoord last{1 << 20, 0, 0};
  for (int second = 0; second < 100; ++second) {
    const WorldPos at = behaviour->position(second);
    const double distance = std::hypot(at.x - from.x, at.z - from.z);
    CHECK(distance > way);
    way = distance;
    const ChunkCoord chunk =
        chunk_of({static_cast<std::int32_t>(at.x), 0, static_cast<std::int32_t>(at.z)}, kEdge);
    CHECK(chunk != last);
    last = chunk;
  }
  CHECK(edits_of(BotRole::run_away, place, 1, 10).empty());
  CHECK(edits_of(BotRole::join_storm, place, 1, 10).empty());
}
