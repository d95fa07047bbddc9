// Claims of tiles: what a client has is not sent again, and claims cost the server little.
#include "server/world/ground/chunk_sending.hpp"
#include "server/world/ground/tiles.hpp"
#include "tests/unit/server/world/ground/tile_bench.hpp"

namespace runstone::test {
namespace {

constexpr std::size_t kAllTiles = 13 * (5 + 2 + 2);  // of the view of TileBench
const ChunkKey kRootTile{3, {0, 0, 0}}, kFineTile{1, {0, 0, 0}};

struct ClaimBench : TileBench {
  using TileBench::TileBench;

  /// Joins, claims before the view, and looks.
  void enter_with(std::vector<CachedChunk> claims, std::uint64_t features = kFeatureTiles) {
    join(1, 1, 1, {}, features);
    for (Message& message : cached_chunks_messages(claims))
      server.received(1, std::move(message), now());
    look(1, 3, {});
  }
  /// The claim of a tile as the workers make it.
  CachedChunk claim_of(const ChunkKey& key) const {
    const ChunkPtr tile = made(key, 0).tile;
    return {key, tile->version, claim_digest(tile->digest)};
  }
  /// Claims of all tiles with ground, of a level.
  std::vector<CachedChunk> ground_claims(std::uint8_t level) const {
    std::vector<CachedChunk> out;
    for (std::int32_t x = -2; x <= 2; ++x) {
      for (std::int32_t z = -2; z <= 2; ++z) {
        if (x * x + z * z <= 4) out.push_back(claim_of({level, {x, 0, z}}));
      }
    }
    return out;
  }
  std::multiset<ChunkKey> not_modified() const {
    std::multiset<ChunkKey> keys;
    for (const ChunksNotModified& same : environment.messages<ChunksNotModified>(1, kEdge)) {
      for (const UnmodifiedChunk& one : same.chunks) keys.insert(one.key);
    }
    return keys;
  }
  bool is_closed() const { return !environment.closed.empty(); }
};

}  // namespace

TEST_CASE("a copy that is known to be current is answered without a tile being made", "[world]") {
  ClaimBench bench;
  std::vector<CachedChunk> claims;
  for (std::uint8_t level = 1; level <= 3; ++level) {
    const auto more = bench.ground_claims(level);
    claims.insert(claims.end(), more.begin(), more.end());
  }
  bench.environment.current_tiles = claims;
  bench.enter_with(claims);
  for (const TileRequest& request : bench.answer_tiles()) CHECK(request.key.at.y != 0);
  CHECK(bench.not_modified().size() == claims.size());
  CHECK(bench.tiles_of(1).size() == kAllTiles - claims.size());
  CHECK(bench.server.counters().tiles_not_modified == claims.size());
  // From then on the session gets what edits change.
  bench.look(1, 3, kAside);
  bench.answer_tiles();
  bench.edit(1, 1, kAtOrigin);
  for (int n = 0; n < 10; ++n) {
    bench.tick(500'000);
    bench.answer_tiles();
  }
  CHECK(bench.tiles_of(1).count(kFineTile) == 1);
}

TEST_CASE("a copy that is not known to be current is compared with the tile", "[world]") {
  ClaimBench bench;
  CachedChunk same = bench.claim_of(kRootTile), other = bench.claim_of({3, {1, 0, 0}}),
              older = bench.claim_of({3, {-1, 0, 0}});
  other.digest ^= 1;
  older.version = {1, 7};
  bench.enter_with({older, same, other});
  bench.answer_tiles();
  CHECK(bench.not_modified() == std::multiset<ChunkKey>{kRootTile});
  CHECK(bench.tiles_of(1).count(kRootTile) == 0);
  CHECK(bench.tiles_of(1).count(other.key) == 1);
  CHECK(bench.tiles_of(1).count(older.key) == 1);
  CHECK(bench.tiles_of(1).size() == kAllTiles - 1);
}

TEST_CASE("a claim of a uniform tile is of no use", "[world]") {
  ClaimBench bench;
  const ChunkKey sky{3, {0, 1, 0}};
  bench.enter_with({bench.claim_of(sky)});
  bench.answer_tiles();
  CHECK(bench.not_modified().empty());
  CHECK(bench.tiles_of(1).count(sky) == 1);
}

TEST_CASE("claims without the feature, of levels that are not made, and of sent tiles are ignored",
          "[world]") {
  ClaimBench bench;
  SECTION("without the feature") {
    bench.environment.current_tiles = {bench.claim_of(kRootTile)};
    bench.enter_with({bench.claim_of(kRootTile)}, 0);
    CHECK(bench.environment.tile_checks == 0);
  }
  SECTION("of levels above those of the server") {
    const CachedChunk high = bench.claim_of({8, {0, 0, 0}});
    bench.environment.current_tiles = {high};
    bench.enter_with({high});
    CHECK(bench.environment.tile_checks == 0);
  }
  SECTION("outside of the view") {
    const CachedChunk far = bench.claim_of({3, {500, 0, 0}});
    bench.enter_with({far});
    bench.answer_tiles();
    CHECK(bench.environment.tile_checks == 0);
  }
  SECTION("of tiles that the session has") {
    bench.enter_with({});
    bench.answer_tiles();
    bench.environment.current_tiles = {bench.claim_of(kRootTile)};
    bench.server.received(1, CachedChunks{bench.environment.current_tiles}, bench.now());
    bench.tick(1'000'000);
    CHECK(bench.environment.tile_checks == 0);
  }
  CHECK(bench.not_modified().empty());
  CHECK_FALSE(bench.is_closed());
}

TEST_CASE("claims of tiles that were never sent harm only the session that makes them", "[world]") {
  ClaimBench bench;
  bench.environment.current_tiles = bench.ground_claims(1);
  // Level 1 is below tiles that the session never got: it waits for these first.
  bench.enter_with(bench.environment.current_tiles);
  CHECK(bench.not_modified().empty());
  bench.answer_tiles();
  CHECK(bench.not_modified().size() == 13);
  CHECK(bench.tiles_of(1).size() == kAllTiles - 13);
  bench.join(2, 2, 1, {}, kFeatureTiles);
  bench.look(2, 3, {});
  bench.answer_tiles();
  CHECK(bench.tiles_of(2).size() == kAllTiles);
}

TEST_CASE("the same claim again and again is one claim, and is charged each time", "[world]") {
  ClaimBench bench;
  bench.join(1, 1, 1, {}, kFeatureTiles);
  const CachedChunk claim = bench.claim_of(kRootTile);
  constexpr std::size_t kTimes = kClaimsPerSessionMax + 1;
  for (std::size_t i = 0; i < kTimes; ++i)
    bench.server.received(1, CachedChunks{{claim}}, bench.now());
  CHECK_FALSE(bench.is_closed());
  CHECK(bench.environment.charged[1] == kTimes * kTileClaimBytes);
  bench.look(1, 3, {});
  bench.answer_tiles();
  CHECK(bench.not_modified().count(kRootTile) == 1);
}

TEST_CASE("too many claims of tiles end the session", "[world]") {
  ClaimBench bench;
  bench.join(1, 1, 1, {}, kFeatureTiles);
  std::vector<CachedChunk> claims;
  for (std::size_t i = 0; i <= kClaimsPerSessionMax; ++i)
    claims.push_back({{1, {static_cast<std::int32_t>(i), 0, 0}}, {}, 1});
  for (Message& message : cached_chunks_messages(claims))
    bench.server.received(1, std::move(message), bench.now());
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::flooding);
}

TEST_CASE("one call answers a bounded number of claims, and later calls the others", "[world]") {
  WorldConfig c = with_tiles();
  c.view_radius_max = 16;
  ClaimBench bench(c);
  bench.join(1, 1, 1, {}, kFeatureTiles);
  std::vector<CachedChunk> claims;
  for (std::int32_t x = -16; x <= 16; ++x) {
    for (std::int32_t z = -16; z <= 16; ++z) {
      if (x * x + z * z <= 256) claims.push_back(bench.claim_of({1, {x, 0, z}}));
    }
  }
  REQUIRE(claims.size() > kTileClaimsPerCall);
  bench.environment.current_tiles = claims;
  for (Message& message : cached_chunks_messages(claims))
    bench.server.received(1, std::move(message), bench.now());
  View v;
  v.radius_h = 16;
  v.levels = 1;
  bench.tick(100'000);
  v.number = 1;
  bench.server.received(1, v, bench.now());
  std::size_t before = bench.environment.tile_checks;
  CHECK(before <= kTileClaimsPerCall);
  for (int n = 0; n < 100; ++n) {
    while (bench.server.ground().has_deliveries()) {
      bench.server.ground().deliver_next(bench.now());
      CHECK(bench.environment.tile_checks <= before + kTileClaimsPerCall);
      before = bench.environment.tile_checks;
    }
    bench.answer_tiles();
  }
  CHECK(bench.not_modified().size() == claims.size());
}

TEST_CASE("a view that flips its levels asks again and again, and pays for it", "[world]") {
  WorldConfig c = with_tiles();
  c.chunk_loads = {20, 300};
  ClaimBench bench(c);
  bench.join(1, 1, 1, {}, kFeatureTiles);
  bench.join(2, 2, 1, {}, kFeatureTiles);
  std::size_t made = 0;
  for (std::uint32_t n = 0; n < 200; ++n) {
    View v;
    v.number = n + 1;
    v.centre = {n % 2 == 0 ? 0 : 4096, 0, 0};
    v.radius_h = 2;
    v.levels = static_cast<std::uint8_t>(n % 4);
    bench.server.received(1, v, bench.now());
    bench.tick(10'000);
    CHECK(bench.environment.tile_requests.size() <= kTilesInFlightMax);
    made += bench.answer_tiles().size();
  }
  // Two seconds of loads, and the burst. Chunks take some of them.
  CHECK(made <= 300 + 2 * 20 + 1);
  CHECK_FALSE(bench.is_closed());
  // Nobody else waits: the other session has a budget of its own.
  bench.look(2, 3, {});
  bench.answer_tiles();
  CHECK(bench.tiles_of(2).size() == kAllTiles);
}

}  // namespace runstone::test
