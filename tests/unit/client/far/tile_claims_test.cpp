// Tiles that stay over a connection or come from a cache.
#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <set>
#include <vector>

#include "client/far/far_tiles.hpp"
#include "tests/unit/client/far/some_tile.hpp"

using namespace runstone;
using runstone::test::kTileEdge;
using runstone::test::some_tile;

namespace {

const ChunkKey kFine{1, {0, 0, 0}}, kMiddle{2, {0, 0, 0}}, kCoarse{3, {0, 0, 0}};

Chunk chunk_of_tile(SplitMix64& rng, Sequence seq) {
  Chunk tile{some_tile(rng), {1, seq}, {}};
  if (seq == 0) tile.version = {};
  tile.digest = digest_of(tile.voxels);
  return tile;
}

struct ClaimFixture {
  ClaimFixture() {
    tiles.set_view(view, kTileEdge);
    reopen();
  }
  static View view_of_levels(std::uint8_t levels) {
    View v;
    v.radius_h = 2;
    v.levels = levels;
    return v;
  }
  Chunk tile(Sequence seq) { return chunk_of_tile(rng, seq); }
  ChunkPtr shared_tile(Sequence seq) { return std::make_shared<const Chunk>(tile(seq)); }
  /// Begins a connection to a server that shares the edits up to `common`.
  void reopen(std::uint32_t rules = 1, Sequence common = 100) {
    tiles.reopen(rules, [common](const Version& version) { return version.seq <= common; });
  }
  std::vector<ChunkKey> claimable() const {
    std::vector<ChunkKey> keys;
    tiles.for_each_claimable([&](const ChunkKey& key, const Chunk&) {
      keys.push_back(key);
      return true;
    });
    return keys;
  }

  SplitMix64 rng{5};
  View view = view_of_levels(3);
  FarTiles tiles;
};

}  // namespace

TEST_CASE_METHOD(ClaimFixture,
                 "tiles are claimable on the next connection, until they are answered", "[far]") {
  REQUIRE(tiles.receive(kFine, tile(4)));
  REQUIRE(tiles.receive(kMiddle, tile(0)));
  REQUIRE(tiles.receive_uniform(kCoarse, 1));
  CHECK(claimable().empty());
  reopen();
  CHECK(claimable() == std::vector<ChunkKey>{kFine, kMiddle});
  CHECK_FALSE(tiles.receive_not_modified(kFine, 5));
  CHECK(tiles.receive_not_modified(kFine, 4));
  CHECK(claimable() == std::vector<ChunkKey>{kMiddle});
  REQUIRE(tiles.receive(kMiddle, tile(6)));
  CHECK(claimable().empty());
  CHECK_FALSE(tiles.receive_not_modified(kCoarse, 0));
  CHECK_FALSE(tiles.receive_not_modified({1, {1, 0, 0}}, 0));
}

TEST_CASE_METHOD(ClaimFixture,
                 "a tile is claimed at its newest version, also if its voxels are equal", "[far]") {
  Chunk first = tile(4);
  REQUIRE(tiles.receive(kFine, first));
  const TilePtr shown = tiles.find(kFine);
  first.version.seq = 9;
  REQUIRE(tiles.receive(kFine, first));
  CHECK(tiles.find(kFine) == shown);
  reopen();
  Sequence claimed = 0;
  tiles.for_each_claimable([&](const ChunkKey&, const Chunk& held) {
    claimed = held.version.seq;
    return true;
  });
  CHECK(claimed == 9);
}

TEST_CASE_METHOD(
    ClaimFixture,
    "tiles of lost edits, of other rules, and those that the server will replace are not "
    "claimable",
    "[far]") {
  Chunk incomplete = tile(3);
  incomplete.digest = {};
  REQUIRE(tiles.receive(kFine, tile(4)));
  REQUIRE(tiles.receive({1, {1, 0, 0}}, tile(5)));
  REQUIRE(tiles.receive({1, {0, 0, 1}}, std::move(incomplete)));
  SECTION("lost edits") {
    reopen(1, 4);
    CHECK(claimable() == std::vector<ChunkKey>{kFine});
    reopen(1, 100);  // what was lost does not come back
    CHECK(claimable() == std::vector<ChunkKey>{kFine});
  }
  SECTION("other rules") {
    reopen(2);
    CHECK(claimable().empty());
  }
  SECTION("a server without claims of tiles") {
    reopen(0);
    CHECK(claimable().empty());
    REQUIRE(tiles.receive(kFine, tile(6)));
    CHECK(tiles.take_for_cache(9).empty());
    CHECK(tiles.take_not_held().empty());
  }
  CHECK(tiles.count() == 3);  // they are shown all the same
}

TEST_CASE_METHOD(ClaimFixture,
                 "a tile goes to the cache once per answer, if the server vouches for it",
                 "[far]") {
  REQUIRE(tiles.receive(kFine, tile(4)));
  REQUIRE(tiles.receive(kMiddle, tile(5)));
  REQUIRE(tiles.receive_uniform(kCoarse, 1));
  REQUIRE(tiles.take_for_cache(1).size() == 1);
  CHECK(tiles.has_for_cache());
  const auto more = tiles.take_for_cache(9);
  REQUIRE(more.size() == 1);
  CHECK(more[0].first == kMiddle);
  CHECK(more[0].second->version.seq == 5);
  CHECK(tiles.take_for_cache(9).empty());
  CHECK_FALSE(tiles.has_for_cache());
  REQUIRE(tiles.receive(kFine, tile(7)));
  reopen();
  CHECK(tiles.take_for_cache(9).empty());  // nobody has vouched for it on this connection
  REQUIRE(tiles.receive_not_modified(kFine, 7));
  CHECK(tiles.take_for_cache(9).size() == 1);
}

TEST_CASE_METHOD(ClaimFixture, "a tile of the cache is shown and claimable, unless it is no use",
                 "[far]") {
  const ChunkPtr cached = shared_tile(4);
  CHECK(tiles.adopt(kFine, cached));
  REQUIRE(tiles.find(kFine));
  CHECK(*tiles.find(kFine) == cached->voxels);
  CHECK(tiles.drain_changes() == std::vector<ChunkKey>{kFine});
  CHECK(claimable() == std::vector<ChunkKey>{kFine});
  REQUIRE(tiles.receive_not_modified(kFine, 4));
  CHECK(tiles.take_for_cache(9).empty());  // the cache has it

  REQUIRE(tiles.receive(kMiddle, tile(9)));
  const TilePtr held = tiles.find(kMiddle);
  CHECK_FALSE(tiles.adopt(kMiddle, shared_tile(4)));
  CHECK(tiles.find(kMiddle) == held);
  CHECK_FALSE(tiles.adopt({1, {9, 0, 0}}, shared_tile(4)));  // outside of the view
  CHECK_FALSE(tiles.adopt({1, {1, 0, 0}}, std::make_shared<const Chunk>(
                                              Chunk{uniform_chunk(Extent::cube(8), 1), {}, {}})));
  CHECK(tiles.count() == 2);
  // An empty tile has no tiles below it.
  REQUIRE(tiles.receive_uniform({3, {-1, 0, 0}}, kEmpty));
  CHECK_FALSE(tiles.adopt({1, {-1, 0, 0}}, shared_tile(4)));
  CHECK(tiles.find({1, {-1, 0, 0}}) == nullptr);
}

TEST_CASE_METHOD(ClaimFixture, "the tiles to look for in a cache are those that may be there",
                 "[far]") {
  REQUIRE(tiles.receive(kFine, tile(4)));
  REQUIRE(tiles.receive_uniform({3, {-1, 0, 0}}, kEmpty));
  const std::vector<ChunkKey> keys = tiles.take_not_held();
  CHECK(std::is_sorted(keys.begin(), keys.end()));
  const std::set<ChunkKey> found(keys.begin(), keys.end());
  CHECK(found.count(kFine) == 0);
  CHECK(found.count({1, {-1, 0, 0}}) == 0);
  CHECK(found.count({1, {1, 0, 0}}) == 1);
  CHECK(found.count({3, {1, -2, 1}}) == 1);
  CHECK(tiles.take_not_held().empty());
  view.centre = {2, 0, 0};  // another tile of level 1, the same of the levels above
  tiles.set_view(view, kTileEdge);
  const auto moved = tiles.take_not_held();
  REQUIRE_FALSE(moved.empty());
  CHECK(moved.back().lod == 1);
  reopen();
  CHECK(tiles.take_not_held().back().lod == 3);
}
