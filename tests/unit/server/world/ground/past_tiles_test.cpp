#include "server/world/ground/past_tiles.hpp"

#include <algorithm>
#include <functional>

#include "server/world/ground/tiles.hpp"
#include "tests/unit/server/world/ground/tile_bench.hpp"

namespace runstone::test {
namespace {

using PastRequest = std::pair<SessionId, TileRequest>;

const std::vector<ChunkKey> kAboveEdit = {{3, {}}, {2, {}}, {1, {}}};

/// Session 1 has all tiles of its view. Two edits touched the chunk (0, 0, 0).
struct PastBench : TileBench {
  explicit PastBench(WorldConfig c = with_tiles()) : TileBench(std::move(c)) {
    enter(1);
    answer_tiles();
    edit(1, 1, kAtOrigin);
    tick();
    edit(1, 2, kAtOrigin, 2);
    settle();
  }

  void settle() {
    for (int i = 0; i < 3; ++i) {
      tick(kLongUs);
      answer_tiles();
    }
    environment.snapshots.clear();
  }
  void go_to(Sequence seq, SessionId session = 1) {
    server.received(session, HistoryRequest{++request, HistoryTarget::sequence, seq, 0}, now());
    tick(1'000'000);
    server.ground().history_opened(session, request, OpenedHistory{seq, 0}, now());
    tick();
  }
  void go_live() {
    server.received(1, HistoryRequest{++request, HistoryTarget::live, 0, 0}, now());
    tick(1'000'000);
  }
  /// The tile's version is its moment.
  MadeTile past(const TileRequest& wanted) const {
    MadeTile tile = made(wanted.key, wanted.head);
    Chunk chunk = *tile.tile;
    chunk.version.seq = *wanted.at;
    tile.tile = std::make_shared<const Chunk>(std::move(chunk));
    tile.is_past = true;
    return tile;
  }
  void answer(const PastRequest& one) {
    server.ground().tiles().past_made(one.first, one.second, {past(one.second)}, now());
  }
  std::deque<PastRequest> take_past() { return std::exchange(environment.past_tile_requests, {}); }
  /// Answers the requests for past tiles, also those that follow. Returns their tiles.
  std::vector<ChunkKey> answer_past() {
    std::vector<ChunkKey> keys;
    while (!environment.past_tile_requests.empty()) {
      for (const PastRequest& one : take_past()) {
        keys.push_back(one.second.key);
        answer(one);
      }
    }
    return keys;
  }
  /// Returns the sequence of the tile that the session was sent last, or nullopt.
  std::optional<Sequence> shown(const ChunkKey& key, SessionId session = 1) const {
    std::optional<Sequence> newest;
    for (const auto& sent : environment.snapshots) {
      if (sent.session == session && sent.key == key) newest = sent.chunk->version.seq;
    }
    return newest;
  }

  static constexpr TimeUs kLongUs = 5'000'000;
  std::uint32_t request = 0;
};

}  // namespace

TEST_CASE("a session that moves into the past gets the tiles that differ, and no others",
          "[tiles][travel]") {
  PastBench bench;
  bench.go_to(0);
  for (const auto& [session, request] : bench.environment.past_tile_requests)
    CHECK(request.at == Sequence{0});
  CHECK(bench.answer_past() == kAboveEdit);
  CHECK(bench.answer_tiles().empty());
  for (const ChunkKey& key : kAboveEdit) CHECK(bench.shown(key) == Sequence{0});
  CHECK(bench.environment.snapshots.size() == kAboveEdit.size());
}

TEST_CASE("each move in time brings the tiles that differ, and the return the live ones",
          "[tiles][travel]") {
  PastBench bench;
  bench.go_to(0);
  bench.answer_past();
  bench.go_to(1);
  CHECK(bench.answer_past() == kAboveEdit);
  for (const ChunkKey& key : kAboveEdit) CHECK(bench.shown(key) == Sequence{1});
  bench.go_to(2);  // nothing was edited since
  CHECK(bench.answer_past().empty());
  CHECK(bench.answer_tiles().size() == kAboveEdit.size());
  for (const ChunkKey& key : kAboveEdit) CHECK(bench.shown(key) == Sequence{2});
  bench.go_to(1);
  bench.answer_past();
  bench.go_live();
  CHECK(bench.environment.past_tile_requests.empty());
  bench.answer_tiles();
  for (const ChunkKey& key : kAboveEdit) CHECK(bench.shown(key) == Sequence{2});
}

TEST_CASE("past tiles are made again when materials get shapes, those under way too",
          "[tiles][travel][shapes]") {
  PastBench bench;
  const auto give = [&](Material material) {
    const GivenShape slab{material, {ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}}};
    REQUIRE(bench.server.changes().give_shapes({slab}, bench.now()).has_value());
  };
  bench.go_to(0);
  CHECK(bench.answer_past() == kAboveEdit);
  bench.environment.snapshots.clear();
  give(1);
  bench.tick();
  auto again = bench.answer_past();
  std::ranges::sort(again, std::greater<>());
  CHECK(again == kAboveEdit);
  for (const ChunkKey& key : kAboveEdit) CHECK(bench.shown(key) == Sequence{0});

  bench.go_to(1);
  std::vector<std::pair<PastRequest, MadeTile>> old;
  for (const PastRequest& one : bench.take_past()) old.emplace_back(one, bench.past(one.second));
  REQUIRE_FALSE(old.empty());
  bench.environment.snapshots.clear();
  give(2);
  for (const auto& [one, tile] : old)
    bench.server.ground().tiles().past_made(one.first, one.second, {tile}, bench.now());
  CHECK(bench.environment.snapshots.empty());
  bench.tick();
  bench.answer_past();
  for (const ChunkKey& key : kAboveEdit) CHECK(bench.shown(key) == Sequence{1});
}

TEST_CASE("a session may move to the moment that it sees while its tiles are made",
          "[tiles][travel]") {
  PastBench bench;
  for (int i = 0; i < 20; ++i) bench.go_to(1);
  CHECK(bench.environment.past_tile_requests.size() == kAboveEdit.size());
  CHECK(bench.answer_past() == kAboveEdit);
  for (const ChunkKey& key : kAboveEdit) CHECK(bench.shown(key) == Sequence{1});
  bench.go_live();
  bench.answer_tiles();
  for (const ChunkKey& key : kAboveEdit) CHECK(bench.shown(key) == Sequence{2});
}

TEST_CASE("the answer for an earlier moment is ignored, and its tile is made anew",
          "[tiles][travel]") {
  PastBench bench;
  bench.go_to(0);
  const std::deque<PastRequest> earlier = bench.take_past();
  REQUIRE(earlier.size() == kAboveEdit.size());
  bench.go_to(1);
  for (const PastRequest& one : earlier) bench.answer(one);
  CHECK(std::ranges::none_of(bench.environment.snapshots, [](const auto& sent) {
    return sent.chunk->version.seq == 0 && sent.key.lod > 0;
  }));
  bench.answer_past();
  for (const ChunkKey& key : kAboveEdit) CHECK(bench.shown(key) == Sequence{1});
}

TEST_CASE("a session that moves on and on has few requests with workers", "[tiles][travel]") {
  PastBench bench;
  for (Sequence i = 0; i < 40; ++i) {
    bench.go_to(i % 2);
    CHECK(bench.environment.past_tile_requests.size() <= kPastTilesOfSessionMax);
  }
  bench.answer_past();
  bench.tick();
  bench.answer_past();
  for (const ChunkKey& key : kAboveEdit) CHECK(bench.shown(key) == Sequence{1});
}

TEST_CASE("all sessions together have few requests with workers, and each gets its tiles",
          "[tiles][travel]") {
  constexpr SessionId kSessions = 8;
  REQUIRE(kSessions * kAboveEdit.size() > kPastTilesMax);
  PastBench bench;
  for (SessionId id = 2; id <= kSessions; ++id) bench.enter(id);
  bench.settle();
  for (SessionId id = 1; id <= kSessions; ++id) bench.go_to(0, id);
  CHECK(bench.environment.past_tile_requests.size() == kPastTilesMax);
  for (int i = 0; i < 3; ++i) {
    bench.answer_past();
    bench.answer_tiles();
  }
  for (SessionId id = 1; id <= kSessions; ++id) {
    CAPTURE(id);
    for (const ChunkKey& key : kAboveEdit) CHECK(bench.shown(key, id) == Sequence{0});
  }
}

TEST_CASE("edits of others do not change the tiles of a session in the past", "[tiles][travel]") {
  PastBench bench;
  bench.enter(2);
  bench.look(2, 3, kAside);
  bench.answer_tiles();
  bench.go_to(2);
  bench.environment.snapshots.clear();
  bench.edit(2, 1, kAtOrigin, 3);
  for (int i = 0; i < 3; ++i) {
    bench.tick(PastBench::kLongUs);
    bench.answer_tiles();
    bench.answer_past();
  }
  for (const ChunkKey& key : kAboveEdit) CHECK(bench.shown(key).value_or(2) == 2);
  CHECK(std::ranges::any_of(bench.environment.snapshots, [](const auto& sent) {
    return sent.session == 2 && sent.key == ChunkKey{1, {}} && sent.chunk->version.seq == 3;
  }));
  bench.go_live();
  bench.answer_tiles();
  for (const ChunkKey& key : kAboveEdit) CHECK(bench.shown(key) == Sequence{3});
}

TEST_CASE("a tile that was stale when its session went into the past becomes that of the moment",
          "[tiles][travel]") {
  PastBench bench;
  bench.enter(2);
  bench.look(1, 3, kAside);
  bench.answer_tiles();
  bench.edit(1, 3, kAtOrigin, 3);  // the tiles of session 1 lack it when the session moves
  bench.tick();
  bench.server.received(1, HistoryRequest{++bench.request, HistoryTarget::sequence, 3, 0},
                        bench.now());
  bench.server.ground().history_opened(1, bench.request, OpenedHistory{3, 0}, bench.now());
  bench.environment.snapshots.clear();
  bench.edit(2, 1, kAtOrigin, 4);  // and this one comes before they are made again
  for (int i = 0; i < 5; ++i) {
    bench.tick(PastBench::kLongUs);
    bench.answer_tiles();
    bench.answer_past();
  }
  for (const ChunkKey& key : {ChunkKey{2, {}}, ChunkKey{1, {}}})
    CHECK(bench.shown(key) == Sequence{3});
}

TEST_CASE("a past tile that takes long goes on in turns with more steps", "[tiles][travel]") {
  PastBench bench;
  bench.go_to(0);
  const auto first = bench.take_past();
  for (const PastRequest& one : first)
    bench.server.ground().tiles().past_stopped(1, one.second, {bench.past(one.second)},
                                               bench.now());
  const auto second = bench.take_past();
  REQUIRE(second.size() == first.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    CHECK(second[i].second.key == first[i].second.key);
    CHECK(second[i].second.steps_max > first[i].second.steps_max);
    CHECK(second[i].second.past_made == first[i].second.past_made);
  }
  bench.go_live();  // nobody needs them any more
  for (const PastRequest& one : second)
    bench.server.ground().tiles().past_stopped(1, one.second, {}, bench.now());
  CHECK(bench.environment.past_tile_requests.empty());
}

TEST_CASE("a past tile that cannot be made is tried again later", "[tiles][travel]") {
  PastBench bench;
  bench.go_to(0);
  for (const PastRequest& one : bench.take_past())
    bench.server.ground().tiles().past_made(1, one.second, {}, bench.now());
  CHECK(bench.environment.past_tile_requests.empty());
  CHECK(bench.environment.snapshots.empty());
  bench.tick(kTileRetryUs);
  CHECK(bench.answer_past() == kAboveEdit);
  for (const ChunkKey& key : kAboveEdit) CHECK(bench.shown(key) == Sequence{0});
}

TEST_CASE("past tiles wait for room in the queue of their session", "[tiles][travel]") {
  PastBench bench;
  bench.go_to(0);
  bench.environment.snapshot_room[1] = 0;
  bench.answer_past();
  CHECK(bench.environment.snapshots.empty());
  bench.environment.snapshot_room.clear();
  bench.server.drained(1, bench.now());
  bench.answer_past();
  for (const ChunkKey& key : kAboveEdit) CHECK(bench.shown(key) == Sequence{0});
}

TEST_CASE("a view that moves in the past gets past tiles and present ones", "[tiles][travel]") {
  PastBench bench;
  bench.go_to(0);
  bench.look(1, 3, {100, 0, 0});
  CHECK(bench.answer_tiles().size() > 10);
  const auto left_behind = bench.take_past();
  for (const PastRequest& one : left_behind) bench.answer(one);
  for (const ChunkKey& key : kAboveEdit) CHECK_FALSE(bench.shown(key).has_value());
  bench.environment.snapshots.clear();
  bench.look(1, 3, {});
  bench.answer_tiles();
  for (int i = 0; i < 4; ++i) {
    bench.answer_past();
    bench.answer_tiles();
  }
  for (const ChunkKey& key : kAboveEdit) CHECK(bench.shown(key) == Sequence{0});
}

TEST_CASE("a session that leaves gets no past tile, and others may request theirs",
          "[tiles][travel]") {
  PastBench bench;
  bench.go_to(0);
  const auto requests = bench.take_past();
  bench.server.disconnected(1);
  for (const PastRequest& one : requests) bench.answer(one);
  for (const PastRequest& one : requests) CHECK(one.second.at.has_value());
  CHECK(bench.environment.snapshots.empty());
}

TEST_CASE("a player pays for the chunks of past tiles", "[tiles][travel]") {
  WorldConfig c = with_tiles();
  c.chunk_loads = {1, 400};
  PastBench bench(c);
  bench.go_to(0);
  const auto requests = bench.take_past();
  REQUIRE_FALSE(requests.empty());
  TileRequest low = requests.front().second;
  low.key = {1, {}};
  const std::vector<MadeTile> made(100, bench.past(low));  // of level 1: eight chunks each
  bench.server.ground().tiles().past_stopped(1, requests.front().second, made, bench.now());
  bench.take_past();
  bench.go_live();
  bench.tick();
  CHECK(bench.environment.tile_requests.empty());
}

}  // namespace runstone::test
