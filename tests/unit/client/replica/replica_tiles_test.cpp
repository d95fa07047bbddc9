// Tiles: keys of level 1 or more never reach the chunks.
#include "tests/unit/client/far/some_tile.hpp"
#include "tests/unit/client/replica/replica_bench.hpp"

using namespace runstone;
using runstone::test::chunks_of;
using runstone::test::ReplicaBench;
using runstone::test::some_tile;

namespace {

struct TileBench : ReplicaBench {
  TileBench() {
    View view{2, {0, 0, 0}, 2, 2};
    view.levels = 2;
    replica.set_view(view);
  }
  static Chunks message_of(const ChunkKey& key, RunChunk voxels, std::uint32_t view = 2) {
    Chunk chunk;
    chunk.voxels = std::move(voxels);
    return chunks_of(ChunkSnapshot{key, std::move(chunk)}, view);
  }
};

constexpr ChunkKey kTile{1, {0, 0, 0}}, kCoarse{2, {0, 0, 0}};

}  // namespace

TEST_CASE_METHOD(TileBench, "tiles are kept apart from the chunks of the same place", "[replica]") {
  load(kHere);
  SplitMix64 rng{1};
  const RunChunk tile = some_tile(rng);
  replica.receive(message_of(kTile, tile), kNow);
  replica.receive(UniformChunks{2, {{kCoarse, 1, {}}}}, kNow);
  REQUIRE(replica.far_tiles().find(kTile));
  CHECK(*replica.far_tiles().find(kTile) == tile);
  CHECK(replica.far_tiles().count() == 2);
  CHECK(replica.confirmed_count() == 1);
  CHECK(replica.current_count() == 1);
  CHECK(*replica.shown(kHere) == world.chunk(kHere.at).voxels);
  const ReplicaChanges changes = replica.drain_changes();
  CHECK(changes.chunks.empty());
  CHECK(changes.tiles == std::vector<ChunkKey>{kTile, kCoarse});
  CHECK(replica.drain_changes().tiles.empty());
}

TEST_CASE_METHOD(TileBench, "the newest tile counts, whatever view it answers", "[replica]") {
  SplitMix64 rng{2};
  const RunChunk first = some_tile(rng), second = some_tile(rng);
  replica.receive(message_of(kTile, first, 2), kNow);
  replica.receive(message_of(kTile, second, 1), kNow);
  CHECK(*replica.far_tiles().find(kTile) == second);
}

TEST_CASE_METHOD(TileBench, "tiles outside of the view and edits of tiles are ignored",
                 "[replica]") {
  SplitMix64 rng{3};
  replica.receive(message_of({1, {9, 0, 0}}, some_tile(rng)), kNow);
  replica.receive(message_of({3, {0, 0, 0}}, some_tile(rng)), kNow);
  replica.receive(UniformChunks{2, {{{8, {0, 0, 0}}, 1, {}}}}, kNow);
  replica.receive(chunks_of(ChunkEdits{kTile, 0, {}, {}, {}}, 2), kNow);
  replica.receive(ChunkUnavailable{2, {kTile}, UnavailableReason::damaged});
  replica.receive(ChunksNotModified{2, {{kTile, 1}}}, 5);
  replica.receive(DigestCheck{{{kTile, {}, {}}}}, 6);
  CHECK(replica.far_tiles().count() == 0);
  CHECK(replica.unavailable_count() == 0);
  CHECK(replica.confirmed_count() == 0);
  CHECK(replica.counters().answers_outside == 6);
  CHECK(replica.take_requests().empty());
}

TEST_CASE_METHOD(TileBench, "tiles stay in the past and on a new connection, and leave with a view",
                 "[replica]") {
  SplitMix64 rng{4};
  replica.receive(message_of(kTile, some_tile(rng)), kNow);
  replica.show_moment(PastMoment{1, 0});
  CHECK(replica.far_tiles().count() == 1);
  replica.receive(UniformChunks{2, {{kCoarse, 1, {}}}}, kNow);
  CHECK(replica.far_tiles().count() == 2);
  replica.show_moment(std::nullopt);
  static_cast<void>(replica.open(parameters()));
  CHECK(replica.far_tiles().count() == 2);
  CHECK(replica.take_claims().empty());
  replica.set_view({3, {0, 0, 0}, 2, 2});
  CHECK(replica.far_tiles().count() == 0);
  replica.reset();
  CHECK(replica.far_tiles().bytes() == 0);
}

TEST_CASE_METHOD(TileBench, "tiles are claimed after chunks on the next connection, and once",
                 "[replica]") {
  SessionParameters with_tiles = parameters();
  with_tiles.tile_rules = 1;
  static_cast<void>(replica.open(with_tiles));
  load(kHere);
  SplitMix64 rng{5};
  Chunk tile{some_tile(rng), {}, {}};
  tile.digest = digest_of(tile.voxels);
  Chunk drifted = tile;
  drifted.digest.lane[0] ^= 1;
  const ChunkKey other{1, {1, 0, 0}};
  replica.receive(chunks_of(ChunkSnapshot{kTile, tile}, 2), kNow);
  replica.receive(chunks_of(ChunkSnapshot{other, drifted}, 2), kNow);
  CHECK(replica.take_claims().empty());
  static_cast<void>(replica.open(with_tiles));
  const auto claims = replica.take_claims();
  REQUIRE(claims.size() == 2);
  CHECK(claims[0].key == kHere);
  CHECK(claims[1] == CachedChunk{kTile, {}, claim_digest(tile.digest)});
  CHECK(replica.take_claims().empty());
  replica.receive(ChunksNotModified{2, {{kTile, 0}}}, 5);
  CHECK(replica.counters().answers_outside == 0);
  const auto kept = replica.take_for_cache(9);
  REQUIRE(kept.size() == 1);
  CHECK(kept[0].first == kTile);
  // A tile that comes back into the view is claimed again.
  View away{3, {40, 0, 0}, 2, 2};
  away.levels = 2;
  replica.set_view(away);
  away.number = 4;
  away.centre = {};
  replica.set_view(away);
  replica.adopt(kTile, kept[0].second, 6);
  CHECK(replica.take_claims().size() == 1);
}

TEST_CASE_METHOD(TileBench, "tiles that come after materials got shapes are not kept or claimed",
                 "[replica][shapes]") {
  SessionParameters with_tiles = parameters();
  with_tiles.tile_rules = 1;
  static_cast<void>(replica.open(with_tiles));
  SplitMix64 rng{6};
  const auto tile = [&] {
    Chunk made{some_tile(rng), {}, {}};
    made.digest = digest_of(made.voxels);
    return made;
  };
  const ChunkKey other{1, {1, 0, 0}}, third{1, {0, 0, 1}};
  replica.receive(chunks_of(ChunkSnapshot{kTile, tile()}, 2), kNow);
  replica.end_tile_rules();
  replica.receive(chunks_of(ChunkSnapshot{other, tile()}, 2), kNow);
  CHECK(replica.take_missing_tiles().empty());  // a cache has none of these rules
  replica.adopt(third, std::make_shared<const Chunk>(tile()), 5);
  CHECK(replica.far_tiles().count() == 2);
  const auto kept = replica.take_for_cache(9);
  REQUIRE(kept.size() == 1);
  CHECK(kept[0].first == kTile);
  // The world has the number of before again: its newest edits were lost.
  static_cast<void>(replica.open(with_tiles));
  const auto claims = replica.take_claims();
  CHECK(std::ranges::none_of(claims, [&](const auto& claim) { return claim.key == other; }));
  CHECK(replica.far_tiles().count() == 2);
}
