// Tiles after materials got shapes: what sessions have is made again, and copies that clients kept
// before are compared with it.
#include <algorithm>

#include "common/tiles/tile_rules.hpp"
#include "server/world/ground/tiles.hpp"
#include "tests/unit/server/world/ground/tile_bench.hpp"

namespace runstone::test {
namespace {

const Shape kHalf{ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};
const ChunkKey kTile{1, {0, 0, 0}};

struct ReshapedBench : TileBench {
  using TileBench::TileBench;

  void give(Material material) {
    REQUIRE(server.changes().give_shapes({{material, kHalf}}, now()).has_value());
  }
  /// Answers all requests for some seconds. The tile kTile has other voxels than before.
  std::multiset<ChunkKey> make_all() {
    std::multiset<ChunkKey> keys;
    for (int n = 0; n < 20; ++n) {
      while (!environment.tile_requests.empty()) {
        const TileRequest request = environment.tile_requests.front();
        environment.tile_requests.pop_front();
        keys.insert(request.key);
        MadeTile tile = made(request.key, request.head);
        if (request.key == kTile) {
          Chunk other = *tile.tile;
          fill(other.voxels, 0, 1, Material{4});
          tile.voxel_digest = other.digest = digest_of(other.voxels);
          tile.tile = std::make_shared<const Chunk>(std::move(other));
        }
        server.ground().tiles().made(request.key, {tile}, now());
      }
      tick(500'000);
    }
    return keys;
  }
  std::uint32_t accepted_rules(SessionId session) const {
    return environment.messages<SessionAccepted>(session, kEdge).at(0).tile_rules;
  }
};

}  // namespace

TEST_CASE("tiles are made again after shapes were given, and those that changed are sent",
          "[world][shapes]") {
  ReshapedBench bench;
  bench.enter(1);
  bench.answer_tiles();
  bench.look(1, 3, kAside);  // nothing is hidden
  bench.answer_tiles();
  const auto before = bench.tiles_of(1);
  CHECK(bench.accepted_rules(1) == kTileRules);
  bench.give(1);
  const std::uint32_t rules = bench.server.order().tile_rules();
  CHECK(rules == tile_rules_of(tile_shapes_number(bench.server.order().materials())));
  CHECK(rules != kTileRules);
  bench.tick();
  const auto made = bench.make_all();
  CHECK(made.count(kTile) == 1);
  CHECK(made.count({3, {0, 0, 0}}) == 1);
  const auto after = bench.tiles_of(1);
  CHECK(after.count(kTile) == before.count(kTile) + 1);
  CHECK(after.size() == before.size() + 1);
  // A session that joins now gets the new number.
  bench.enter(2);
  CHECK(bench.accepted_rules(2) == rules);
  bench.enter(3, 0, 0);
  CHECK(bench.accepted_rules(3) == 0);
}

TEST_CASE("a tile that was under way when shapes were given is made again before it is sent",
          "[world][shapes]") {
  ReshapedBench bench;
  bench.enter(1);
  REQUIRE_FALSE(bench.environment.tile_requests.empty());
  const TileRequest request = bench.environment.tile_requests.front();
  bench.environment.tile_requests.pop_front();
  const MadeTile old = bench.made(request.key, request.head);
  bench.give(2);
  bench.server.ground().tiles().made(request.key, {old}, bench.now());
  bench.tick();
  CHECK(bench.tiles_of(1).empty());
  CHECK(bench.environment.saved_tiles.empty());
  bench.make_all();
  CHECK(bench.tiles_of(1).count(request.key) == 1);
}

TEST_CASE("a claim of a session that joined before shapes were given is compared with the tile",
          "[world][shapes]") {
  ReshapedBench bench;
  const auto claim_of = [&](const ChunkKey& key) {
    const MadeTile made = bench.made(key, 0);
    return CachedChunk{key, made.tile->version, claim_digest(made.tile->digest)};
  };
  const std::vector<CachedChunk> claims = {claim_of(kTile), claim_of({2, {0, 0, 0}})};
  bench.environment.current_tiles = claims;  // by their versions alone
  bench.join(1, 1, 1, {}, kFeatureTiles);
  bench.give(1);
  for (Message& message : cached_chunks_messages(claims))
    bench.server.received(1, std::move(message), bench.now());
  bench.look(1, 3, {});
  const auto made = bench.make_all();
  CHECK(bench.environment.tile_checks == 0);
  CHECK(made.count(kTile) == 1);
  CHECK(bench.tiles_of(1).count(kTile) == 1);
  CHECK(bench.server.counters().tiles_not_modified == 1);  // the other one has not changed
}

}  // namespace runstone::test
