#include "server/world/ground/tiles.hpp"

#include <algorithm>
#include <set>

#include "common/runs/run_chunk.hpp"
#include "server/world/ground/tile_board.hpp"
#include "tests/unit/server/world/ground/tile_bench.hpp"

namespace runstone::test {
namespace {

const ChunkKey kAbove{3, {0, 1, 0}};  // a tile of TileBench without ground

/// Returns a tile with this version, a voxel of which is of `material`.
MadeTile with_voxel(const ChunkKey& key, Version version, Material material, Sequence through) {
  Chunk tile = dotted_chunk(kEdge);
  fill(tile.voxels, 0, 1, material);
  tile.version = version;
  tile.digest = digest_of(tile.voxels);
  MadeTile out{key, nullptr, through};
  out.voxel_digest = tile.digest;
  out.tile = std::make_shared<const Chunk>(std::move(tile));
  return out;
}

/// Answers all requests without letting time pass, and returns them. The request for the tile of
/// `special` is answered by that tile.
std::vector<TileRequest> answer_at_once(TileBench& bench,
                                        const std::optional<MadeTile>& special = std::nullopt) {
  std::vector<TileRequest> out;
  std::deque<TileRequest>& requests = bench.environment.tile_requests;
  while (!requests.empty()) {
    out.push_back(requests.front());
    requests.pop_front();
    if (special && out.back().key == special->key) {
      bench.server.ground().tiles().made(special->key, {*special}, bench.now());
    } else {
      bench.answer(out.back());
    }
  }
  return out;
}

}  // namespace

TEST_CASE("a session gets the tiles of its view, coarse ones first, and nothing below empty ones") {
  TileBench bench;
  bench.enter(1);
  const std::vector<TileRequest> requests = bench.answer_tiles();
  REQUIRE_FALSE(requests.empty());
  CHECK(requests.front().key.lod == 3);
  CHECK(requests.back().key.lod == 1);
  const std::multiset<ChunkKey> tiles = bench.tiles_of(1);
  // A disc of radius 2 has 13 columns. Level 3 has all five heights, the others those below y = 0.
  CHECK(tiles.size() == 13 * (5 + 2 + 2));
  CHECK(tiles.count({1, {0, 0, 0}}) == 1);
  CHECK(tiles.count({1, {0, 1, 0}}) == 1);
  CHECK(tiles.count({2, {0, 2, 0}}) == 0);
}

TEST_CASE("a client without the feature or without levels gets no tiles") {
  TileBench bench;
  bench.enter(1, 0);
  CHECK(bench.environment.tile_requests.empty());
  bench.enter(2, 3, 0);
  CHECK(bench.environment.tile_requests.empty());
}

TEST_CASE("the server limits the levels of a view") {
  TileBench bench;
  bench.enter(1, 8);
  CHECK(bench.answer_tiles().front().key.lod == 3);
}

TEST_CASE(
    "an edit makes the tiles above it again, the coarser the later, for those who have them") {
  TileBench bench;
  bench.enter(1);
  bench.look(1, 3, kAside);
  bench.enter(2, 0);
  bench.answer_tiles();
  const std::multiset<ChunkKey> before = bench.tiles_of(1);
  bench.edit(1, 1, kAtOrigin);
  bench.tick();
  CHECK(bench.environment.tile_requests.empty());
  std::vector<ChunkKey> made;
  for (int n = 0; n < 30; ++n) {
    bench.tick(500'000);
    for (const TileRequest& request : bench.answer_tiles()) {
      made.push_back(request.key);
      CHECK(request.head == 1);
      REQUIRE(request.fresh.size() == 1);
      CHECK(request.fresh[0].first == ChunkCoord{});
      CHECK(request.fresh[0].second->version.seq == 1);
    }
  }
  CHECK(made == std::vector<ChunkKey>{{1, {}}, {2, {}}, {3, {}}});
  CHECK(bench.tiles_of(1).size() == before.size() + 2);  // the one of level 3 is hidden
  CHECK(bench.tiles_of(2).empty());
}

TEST_CASE("a hidden tile is made once after an edit, and sent when the view moves away from it") {
  TileBench bench;
  const ChunkKey hidden{1, {}};
  bench.enter(1);
  bench.answer_tiles();
  const std::size_t before = bench.tiles_of(1).count(hidden);
  std::size_t made = 0;
  for (Sequence edit = 1; edit <= 5; ++edit) {
    bench.edit(1, edit, kAtOrigin, edit % 2 == 0 ? Material{1} : Material{2});
    for (int n = 0; n < 10; ++n) {
      bench.tick(500'000);
      for (const TileRequest& request : bench.answer_tiles()) made += request.key == hidden;
    }
  }
  CHECK(made == 1);
  CHECK(bench.tiles_of(1).count(hidden) == before);
  bench.look(1, 3, kAside);
  for (const TileRequest& request : bench.answer_tiles()) {
    if (request.key == hidden) CHECK(request.head == 5);
  }
  CHECK(bench.tiles_of(1).count(hidden) == before + 1);
  // From here it is drawn, so the next edit is sent.
  bench.edit(1, 6, kAtOrigin);
  for (int n = 0; n < 10; ++n) {
    bench.tick(500'000);
    bench.answer_tiles();
  }
  CHECK(bench.tiles_of(1).count(hidden) == before + 2);
}

TEST_CASE("a tile with an edit that is not durable is not saved") {
  TileBench bench;
  bench.enter(1);
  bench.look(1, 3, kAside);
  bench.answer_tiles();
  const auto is_saved = [&](Sequence seq) {
    return std::ranges::any_of(bench.environment.saved_tiles,
                               [seq](const auto& one) { return one.second->version.seq == seq; });
  };
  const auto remake = [&] {
    for (int n = 0; n < 10; ++n) {
      bench.tick(500'000);
      bench.answer_tiles();
    }
  };
  bench.edit(1, 1, kAtOrigin);
  remake();
  CHECK_FALSE(is_saved(1));
  bench.edit(1, 2, kAtOrigin, 2);
  bench.tick();
  bench.server.durable(2, bench.now());
  remake();
  CHECK(is_saved(2));
}

TEST_CASE("a tile that one more session wants is not sent again to those who have it") {
  TileBench bench;
  bench.enter(1);
  bench.answer_tiles();
  const std::size_t before = bench.tiles_of(1).size();
  bench.enter(2);
  CHECK(bench.answer_tiles().size() == before);
  CHECK(bench.tiles_of(2).size() == before);
  CHECK(bench.tiles_of(1).size() == before);
}

TEST_CASE("those who have a tile get it again if anything of it has changed") {
  TileBench bench;
  const ChunkKey key{1, {}};
  SessionId newcomer = 1;
  bench.enter(newcomer);
  bench.look(newcomer, 3, kAside);
  bench.answer_tiles();
  // Each newcomer makes the tile be made once more. Returns how often session 1 got it then.
  const auto sent_for = [&](const MadeTile& tile) {
    const std::size_t before = bench.tiles_of(1).count(key);
    bench.enter(++newcomer);
    answer_at_once(bench, tile);
    bench.tick();
    return bench.tiles_of(1).count(key) - before;
  };
  CHECK(sent_for(with_voxel(key, {}, 2, 0)) == 1);
  CHECK(sent_for(with_voxel(key, {}, 2, 0)) == 0);
  CHECK(sent_for(with_voxel(key, {}, 3, 0)) == 1);      // other voxels
  CHECK(sent_for(with_voxel(key, {1, 5}, 3, 5)) == 1);  // a newer version
  CHECK(sent_for(with_voxel(key, {1, 5}, 3, 4)) == 1);  // it may lack edits
  CHECK(sent_for(with_voxel(key, {1, 5}, 3, 4)) == 0);
  CHECK(sent_for(with_voxel(key, {1, 5}, 3, 5)) == 1);  // it is complete
  // A tile that a session requests is no changed tile. The later ones that replace it are.
  const auto changes_of = [&](SessionId session) {
    return std::ranges::count(bench.environment.changed_tiles, std::pair{session, key});
  };
  CHECK(changes_of(1) == 5);
  CHECK(changes_of(newcomer) == 0);
  CHECK(bench.tiles_of(newcomer).count(key) == 1);
}

TEST_CASE("an older state of a tile that waits to be sent is not sent after a newer one") {
  TileBench bench;
  bench.enter(1);
  bench.join(2, 2, 1, {}, kFeatureTiles);
  const MadeTile newer = with_voxel(kAbove, {1, 1}, 2, 1);
  answer_at_once(bench);  // the tile is uniform, so it waits for others
  REQUIRE(bench.tiles_of(1).count(kAbove) == 0);
  View v;
  v.radius_h = 2;
  v.radius_v = 1;
  v.levels = 3;
  bench.send_view(2, v);
  answer_at_once(bench, newer);
  bench.server.ground().resend_tiles(bench.now());
  bench.tick();
  CHECK(bench.tiles_of(1).count(kAbove) == 1);
  const auto& snapshots = bench.environment.snapshots;
  CHECK(std::ranges::any_of(snapshots, [&](const auto& sent) {
    return sent.session == 1 && sent.key == kAbove && sent.chunk == newer.tile;
  }));
}

TEST_CASE("a lone player's changed tiles are all made as soon as they are due") {
  TileBench bench;
  bench.enter(1);
  bench.answer_tiles();
  // More tiles than are made at a time.
  ClientSequence seq = 0;
  for (const auto& [x, z] : {std::pair{-1, -1}, {0, 0}, {-1, 0}, {0, -1}, {2, 0}, {0, 2}})
    bench.edit(1, ++seq, SetVoxel{{x * kEdge, 1, z * kEdge}});
  bench.tick();
  bench.tick(kTileRemakeUs);
  const std::vector<TileRequest> made = answer_at_once(bench);
  CHECK(std::ranges::count_if(made, [](const auto& one) { return one.key.lod == 1; }) == 6);
}

TEST_CASE("a tile that is edited while it is made is made once more and not saved") {
  TileBench bench;
  bench.enter(1);
  const TileRequest first = bench.environment.tile_requests.front();
  bench.environment.tile_requests.pop_front();
  bench.edit(1, 1, kAtOrigin);
  bench.tick();
  bench.environment.tile_edits[first.key] = 1;
  bench.answer(first);
  for (const auto& [key, tile] : bench.environment.saved_tiles) CHECK(key != first.key);
  bench.answer_tiles();
  bench.tick(kTileRetryUs);
  const std::vector<TileRequest> again = bench.answer_tiles();
  CHECK(std::ranges::count(again, first.key, &TileRequest::key) == 1);
}

TEST_CASE("tiles are saved unless they are approximate, uniform or stored already") {
  TileBench bench;
  bench.enter(1);
  const ChunkKey key = bench.environment.tile_requests.front().key;
  bench.environment.tile_requests.pop_front();
  // Those at y = 0 have ground.
  MadeTile stored = bench.made({1, {9, 0, 9}}, 0), approximate = bench.made({1, {8, 0, 9}}, 0);
  stored.is_known = true;
  approximate.is_approximate = true;
  bench.server.ground().tiles().made(key,
                                     {stored, approximate, bench.made({1, {7, 7, 7}}, 0),
                                      bench.made({2, {7, 0, 7}}, 0), bench.made(key, 0)},
                                     bench.now());
  REQUIRE(bench.environment.saved_tiles.size() == 2);
  CHECK(bench.environment.saved_tiles[0].first == ChunkKey{2, {7, 0, 7}});
  CHECK(bench.environment.saved_tiles[1].first == key);
}

TEST_CASE("a player pays for tiles with chunk loads, and gets the others when they come back") {
  WorldConfig c = with_tiles();
  c.chunk_loads = {20, 150};
  TileBench bench(c);
  bench.enter(1);
  const std::size_t at_once = bench.answer_tiles().size();
  // The view has 39 chunks and 65 roots. The 13 roots with ground cost one load more each.
  CHECK(at_once > 65);
  CHECK(at_once < 150 - 39);
  const std::size_t before = bench.answer_tiles().size();
  bench.tick(1'000'000);
  const std::size_t later = before + bench.answer_tiles().size();
  CHECK(later > 0);
  CHECK(later <= 22);
  for (int n = 0; n < 20; ++n) {
    bench.tick(1'000'000);
    bench.answer_tiles();
  }
  CHECK(bench.tiles_of(1).size() == 13 * (5 + 2 + 2));
}

TEST_CASE("a player who leaves before a tile is made owes its price at the next session") {
  WorldConfig c = with_tiles();
  c.chunk_loads = {1, 200};
  TileBench bench(c);
  bench.enter(1);
  const ChunkKey key = bench.environment.tile_requests.front().key;
  bench.environment.tile_requests.clear();
  bench.server.disconnected(1);
  std::vector<MadeTile> made(100, bench.made({1, {9, 0, 9}}, 0));
  made.push_back(bench.made(key, 0));
  bench.server.ground().tiles().made(key, made, bench.now());
  bench.join(2, 1, 2, {}, kFeatureTiles);  // the same player
  bench.look(2, 3, {});
  CHECK(bench.environment.tile_requests.empty());
}

TEST_CASE("a tile that could not be made is requested again after a pause") {
  TileBench bench;
  bench.enter(1);
  const ChunkKey key = bench.environment.tile_requests.front().key;
  bench.environment.tile_requests.pop_front();
  bench.server.ground().tiles().made(key, {}, bench.now());
  bench.answer_tiles();
  CHECK(bench.tiles_of(1).count(key) == 0);
  bench.tick(kTileRetryUs);
  bench.answer_tiles();
  CHECK(bench.tiles_of(1).count(key) == 1);
}

TEST_CASE("a full queue delays tiles and loses none") {
  TileBench bench;
  bench.environment.full.insert(1);
  bench.environment.snapshot_room[1] = 0;
  bench.environment.full.clear();
  bench.enter(1);
  bench.answer_tiles();
  CHECK(bench.tiles_of(1).count({3, {}}) == 0);
  bench.environment.snapshot_room.clear();
  for (int n = 0; n < 40; ++n) {
    bench.server.drained(1, bench.now());
    bench.answer_tiles();
  }
  CHECK(bench.tiles_of(1).size() == 13 * (5 + 2 + 2));
}

TEST_CASE("a session that leaves while a tile waits for its full queue gets no tile") {
  TileBench bench;
  bench.enter(1);
  bench.enter(2);
  bench.answer_tiles();
  bench.environment.snapshot_room[1] = 0;
  bench.edit(2, 1, kAtOrigin);
  for (int n = 0; n < 4; ++n) {
    bench.tick(10'000'000);
    bench.answer_tiles();
  }
  bench.server.disconnected(1);
  const std::size_t before = bench.tiles_of(1).size();
  bench.edit(2, 2, kAtOrigin);
  for (int n = 0; n < 4; ++n) {
    bench.tick(10'000'000);
    bench.answer_tiles();
  }
  CHECK(bench.tiles_of(1).size() == before);
}

TEST_CASE("a session whose queue was full gets the newest tile when it has room again") {
  TileBench bench;
  bench.enter(1);
  bench.enter(2);
  bench.look(1, 3, kAside);
  bench.answer_tiles();
  const ChunkKey key{1, {}};
  const std::size_t before = bench.tiles_of(1).count(key);
  bench.environment.snapshot_room[1] = 0;
  for (ClientSequence seq = 1; seq <= 2; ++seq) {
    bench.edit(2, seq, SetVoxel{{1, static_cast<std::int32_t>(seq), 1}});
    for (int n = 0; n < 5; ++n) {
      bench.tick(kTileRemakeUs);
      bench.answer_tiles();
    }
  }
  CHECK(bench.tiles_of(1).count(key) == before);
  bench.environment.snapshot_room.clear();
  bench.server.drained(1, bench.now());
  bench.answer_tiles();
  REQUIRE(bench.tiles_of(1).count(key) == before + 1);
  Sequence newest = 0;
  for (const auto& sent : bench.environment.snapshots) {
    if (sent.session == 1 && sent.key == key) newest = sent.chunk->version.seq;
  }
  CHECK(newest == 2);
}

TEST_CASE("a session that sees the past gets the tiles of a view to which it moves") {
  TileBench bench;
  bench.enter(1);
  bench.answer_tiles();
  bench.server.received(1, HistoryRequest{1, HistoryTarget::sequence, 0, 0}, bench.now());
  bench.tick(1'000'000);
  REQUIRE(bench.environment.history_requests.size() == 1);
  bench.server.ground().history_opened(1, 1, OpenedHistory{0, 0}, bench.now());
  bench.look(1, 3, {100, 0, 0});
  bench.answer_tiles();
  CHECK(bench.tiles_of(1).count({3, {12, 0, 0}}) == 1);
}

TEST_CASE("a session that leaves or moves away makes no work any more") {
  TileBench bench;
  bench.enter(1);
  bench.answer_tiles();
  bench.edit(1, 1, kAtOrigin);
  bench.tick();
  bench.look(1, 3, {1000, 0, 0});
  for (const TileRequest& request : bench.answer_tiles()) CHECK(request.key.at.x > 100);
  bench.edit(1, 2, SetVoxel{{1000 * kEdge, 1, 1}});
  bench.tick();
  bench.server.disconnected(1);
  bench.tick(60'000'000);
  CHECK(bench.environment.tile_requests.empty());
}

TEST_CASE("chunks with edits that are not in memory are loaded, and the tile is made once more") {
  TileBench bench;
  bench.enter(1);
  bench.answer_tiles();
  // Nobody sees this chunk, so it is not in memory. It lies below a tile of level 3 of the view.
  bench.edit(1, 1, SetVoxel{{6 * kEdge, 1, 1}});
  bench.tick();
  REQUIRE(bench.server.order().chunks().find({0, {6, 0, 0}}) == nullptr);
  bench.tick(5'000'000);
  const auto heads = [&] {
    std::vector<Sequence> found;
    for (const TileRequest& request : bench.answer_tiles()) {
      if (request.key == ChunkKey{3, {}}) found.push_back(request.head);
    }
    return found;
  };
  CHECK(heads() == std::vector<Sequence>{0});
  bench.answer_loads();
  REQUIRE(bench.server.order().chunks().find({0, {6, 0, 0}}) != nullptr);
  bench.tick(kTileRetryUs);
  CHECK(heads() == std::vector<Sequence>{1});
  bench.tick(60'000'000);
  CHECK(heads().empty());
}

TEST_CASE("a request of a tile that stops is made again with more steps, and others get a turn") {
  TileBench bench;
  bench.enter(1);
  const TileRequest first = bench.environment.tile_requests.front();
  bench.environment.tile_requests.pop_front();
  CHECK(first.steps_max == kTileSteps);
  MadeTile below = bench.made({2, {0, 0, 0}}, 0);
  bench.server.ground().tiles().stopped(first.key, {below}, bench.now());
  REQUIRE(bench.environment.saved_tiles.size() == 1);
  CHECK(bench.environment.saved_tiles[0].first == below.key);
  CHECK(bench.tiles_of(1).empty());
  const std::vector<TileRequest> requests = bench.answer_tiles();
  const auto again = std::ranges::find(requests, first.key, &TileRequest::key);
  REQUIRE(again != requests.end());
  CHECK(again != requests.begin());
  CHECK(again->steps_max == 2 * kTileSteps);
  CHECK(bench.tiles_of(1).size() == 13 * (5 + 2 + 2));
}

TEST_CASE("a player pays for each turn of a tile") {
  WorldConfig c = with_tiles();
  c.chunk_loads = {1, 200};
  TileBench bench(c);
  bench.enter(1);
  const ChunkKey key = bench.environment.tile_requests.front().key;
  std::vector<MadeTile> made(200, bench.made({1, {9, 0, 9}}, 0));
  bench.environment.tile_requests.pop_front();
  bench.server.ground().tiles().stopped(key, made, bench.now());
  // What is under way and what waits goes on; nothing more is requested.
  CHECK(bench.answer_tiles().size() <= kTilesWaitingMax);
  bench.server.disconnected(1);
  bench.join(2, 1, 2, {}, kFeatureTiles);  // the same player
  bench.look(2, 3, {});
  CHECK(bench.environment.tile_requests.empty());
}

}  // namespace runstone::test
