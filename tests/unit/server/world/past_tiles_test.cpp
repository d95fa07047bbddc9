#include "server/world/past_tiles.hpp"

#include <algorithm>

#include "tests/unit/server/world/tile_bench.hpp"

namespace runstone::test {
namespace {

using PastTileRequest = FakeEnvironment::PastTileRequest;

/// A session that has all tiles of its view, and sees the world before an edit of the chunk (0, 0, 0)
/// and the one after it.
struct PastBench : TileBench {
  explicit PastBench(WorldConfig c = with_tiles()) : TileBench(std::move(c)) {
    enter(1);
    answer_tiles();
    edit(1, 1, kAtOrigin);
    tick();
    edit(1, 2, kAtOrigin, 2);
    tick(kLongUs);
    answer_tiles();
    environment.snapshots.clear();
  }

  void go_to(Sequence seq) {
    const HistoryRequest wanted{++request, HistoryTarget::sequence, seq, 0};
    server.received(1, wanted, now());
    tick(1'000'000);
    server.history_opened(1, request, OpenedHistory{seq, 0}, now());
    tick();
  }
  void go_live() {
    server.received(1, HistoryRequest{++request, HistoryTarget::live, 0, 0}, now());
    tick(1'000'000);
  }
  /// Answers the requests for tiles of the past, also those that follow. Returns them.
  std::vector<PastTileRequest> answer_past() {
    std::vector<PastTileRequest> out;
    std::deque<PastTileRequest>& requests = environment.past_tile_requests;
    while (!requests.empty()) {
      out.push_back(requests.front());
      requests.pop_front();
      const TileRequest& wanted = out.back().request;
      server.past_tile_made(out.back().session, out.back().history, wanted,
                            {made(wanted.key, wanted.head)}, now());
    }
    return out;
  }
  /// Returns the sequence of the tile that the session was sent last, or nullopt.
  std::optional<Sequence> newest_sent(const ChunkKey& key) const {
    std::optional<Sequence> newest;
    for (const auto& sent : environment.snapshots) {
      if (sent.session == 1 && sent.key == key) newest = sent.chunk->version.seq;
    }
    return newest;
  }

  static constexpr TimeUs kLongUs = 5'000'000;
  std::uint32_t request = 0;
};

const std::vector<ChunkKey> kAboveEdit = {{3, {}}, {2, {}}, {1, {}}};

std::vector<ChunkKey> keys_of(const std::vector<PastTileRequest>& requests) {
  std::vector<ChunkKey> keys;
  for (const PastTileRequest& one : requests) keys.push_back(one.request.key);
  return keys;
}

}  // namespace

TEST_CASE("a session that moves into the past gets the tiles that differ, and those alone",
          "[tiles]") {
  PastBench bench;
  bench.go_to(0);
  const auto requests = bench.answer_past();
  CHECK(keys_of(requests) == kAboveEdit);
  for (const PastTileRequest& one : requests) CHECK(one.request.at == Sequence{0});
  CHECK(bench.answer_tiles().empty());
  for (const ChunkKey& key : kAboveEdit) CHECK(bench.newest_sent(key) == Sequence{0});
  CHECK(bench.environment.snapshots.size() == kAboveEdit.size());
}

TEST_CASE("tiles of the moment follow each move in time, and the live ones the return", "[tiles]") {
  PastBench bench;
  bench.go_to(0);
  bench.answer_past();
  bench.go_to(1);
  CHECK(keys_of(bench.answer_past()) == kAboveEdit);
  bench.go_to(2);  // nothing was edited since
  CHECK(bench.answer_past().empty());
  CHECK(bench.answer_tiles().size() == kAboveEdit.size());
  for (const ChunkKey& key : kAboveEdit) CHECK(bench.newest_sent(key) == Sequence{2});
  bench.go_to(1);
  bench.answer_past();
  bench.environment.snapshots.clear();
  bench.go_live();
  CHECK(bench.environment.past_tile_requests.empty());
  CHECK(bench.answer_tiles().size() == kAboveEdit.size());
  CHECK(bench.environment.snapshots.size() >= kAboveEdit.size());
}

TEST_CASE("edits of others do not change the tiles of a session in the past", "[tiles]") {
  PastBench bench;
  bench.enter(2);
  bench.answer_tiles();
  bench.go_to(2);
  bench.environment.snapshots.clear();
  bench.edit(2, 1, kAtOrigin, 3);
  bench.tick(PastBench::kLongUs);
  bench.answer_tiles();
  bench.tick(PastBench::kLongUs);
  bench.answer_tiles();
  CHECK(std::ranges::none_of(bench.environment.snapshots, [](const auto& sent) {
    return sent.session == 1 && sent.chunk->version.seq > 2;
  }));
  CHECK(std::ranges::any_of(bench.environment.snapshots, [](const auto& sent) {
    return sent.session == 2 && sent.key == ChunkKey{1, {}};
  }));
  bench.go_live();
  bench.answer_tiles();
  CHECK(bench.newest_sent({1, {}}).has_value());
}

TEST_CASE("an answer for an earlier moment is ignored, and its tile is made anew", "[tiles]") {
  PastBench bench;
  bench.go_to(0);
  const std::deque<PastTileRequest> earlier = bench.environment.past_tile_requests;
  REQUIRE_FALSE(earlier.empty());
  bench.environment.past_tile_requests.clear();
  bench.go_to(1);
  for (const PastTileRequest& one : earlier) {
    bench.server.past_tile_made(1, one.history, one.request, {bench.made(one.request.key, 0)},
                                bench.now());
  }
  CHECK(bench.environment.snapshots.empty());
  const auto requests = bench.answer_past();
  CHECK(keys_of(requests) == kAboveEdit);
  for (const PastTileRequest& one : requests) CHECK(one.request.at == Sequence{1});
}

TEST_CASE("a tile of the past that takes long goes on, and one that cannot be made stays",
          "[tiles]") {
  PastBench bench;
  bench.go_to(0);
  REQUIRE(bench.environment.past_tile_requests.size() == kAboveEdit.size());
  const PastTileRequest first = bench.environment.past_tile_requests.front();
  bench.environment.past_tile_requests.clear();
  bench.server.past_tile_stopped(1, first.history, first.request, {}, bench.now());
  REQUIRE(bench.environment.past_tile_requests.size() == 1);
  CHECK(bench.environment.past_tile_requests.front().request.steps_max > first.request.steps_max);
  bench.environment.past_tile_requests.clear();
  bench.server.past_tile_made(1, first.history, first.request, {}, bench.now());
  CHECK(bench.environment.snapshots.empty());
  bench.answer_past();
  bench.go_live();
  bench.answer_tiles();
  CHECK(bench.newest_sent(first.request.key).has_value());
}

TEST_CASE("a session that leaves gets no tile of the past", "[tiles]") {
  PastBench bench;
  bench.go_to(0);
  const PastTileRequest first = bench.environment.past_tile_requests.front();
  bench.server.disconnected(1);
  bench.server.past_tile_made(1, first.history, first.request, {bench.made(first.request.key, 0)},
                              bench.now());
  CHECK(bench.environment.snapshots.empty());
}

}  // namespace runstone::test
