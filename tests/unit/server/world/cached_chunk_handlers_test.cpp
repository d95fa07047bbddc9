#include "server/world/cached_chunk_handlers.hpp"

#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {
namespace {

const ChunkKey kHere{0, {0, 0, 0}};

std::uint64_t digest_at(const WorldBench& bench, const ChunkKey& key) {
  return claim_digest(bench.server.find_chunk(key)->digest);
}

/// A world with an edited chunk at the origin, version (epoch 1, seq 1), in memory; session 1 has seen it.
struct Fixture : WorldBench {
  Fixture() {
    join(1, 1);
    view(1, kSmall);
    edit(1, 1, kAtOrigin);
    server.commit(now());
    server.durable(1, now());
    ports.snapshots.clear();
  }
  void claim(SessionId session, const ChunkKey& key, Version version, std::uint64_t digest) {
    server.received(session, CachedChunks{{{key, version, digest}}}, now());
  }
  std::vector<ChunkKey> snapshots_to(SessionId session) const {
    std::vector<ChunkKey> keys;
    for (const auto& sent : ports.snapshots) {
      if (sent.session == session) keys.push_back(sent.key);
    }
    return keys;
  }
};

}  // namespace

TEST_CASE_METHOD(Fixture,
                 "a chunk held at its version with its digest is called the same, and subscribed",
                 "[world]") {
  join(2, 2);
  claim(2, kHere, {1, 1}, digest_at(*this, kHere));
  view(2, kSmall);
  const auto same = ports.messages<ChunksNotModified>(2, kEdge);
  REQUIRE(same.size() == 1);
  CHECK(same[0] == ChunksNotModified{{{kHere, 1}}});
  CHECK(snapshots_to(2).size() == 4);
  CHECK(server.counters().same_sent == 1);
  edit(1, 2, kAtOrigin, 2);
  server.commit(now());
  CHECK(commits(2).size() == 1);
}

TEST_CASE_METHOD(Fixture, "another digest at the same version is sent anew, and counted",
                 "[world]") {
  join(2, 2);
  claim(2, kHere, {1, 1}, digest_at(*this, kHere) ^ 1);
  view(2, kSmall);
  CHECK(ports.messages<ChunksNotModified>(2, kEdge).empty());
  CHECK(snapshots_to(2).size() == 5);
  CHECK(server.counters().claims_drifted == 1);
}

TEST_CASE_METHOD(Fixture,
                 "an earlier version may be brought up to date, once the edits between are on disk",
                 "[world]") {
  const std::uint64_t digest = digest_at(*this, kHere);
  edit(1, 2, kAtOrigin, 2);
  server.commit(now());
  join(2, 2);
  claim(2, kHere, {1, 1}, digest);
  view(2, kSmall);
  CHECK(ports.updates.empty());  // sequence 2 is not durable: nobody could read it
  CHECK(snapshots_to(2).size() == 5);
  server.durable(2, now());
  join(3, 3);
  claim(3, kHere, {1, 1}, digest);
  view(3, kSmall);
  REQUIRE(ports.updates.size() == 1);
  CHECK(ports.updates[0] == std::pair(kHere, Version{1, 1}));
  CHECK(server.chunk_version(kHere) == Version{1, 2});
  CHECK(server.counters().updates_sent == 1);
  edit(1, 3, kAtOrigin, 3);  // subscribed in the same step
  server.commit(now());
  CHECK(commits(3).size() == 1);
}

TEST_CASE_METHOD(Fixture, "a version that this server never gave is answered by a snapshot",
                 "[world]") {
  SessionId session = 2;
  for (const Version version : {Version{1, 2}, Version{7, 900}, Version{7, 0}}) {
    join(session, static_cast<std::uint8_t>(session));
    claim(session, kHere, version, digest_at(*this, kHere));
    view(session, kSmall);
    CHECK(snapshots_to(session).size() == 5);
    ++session;
  }
  CHECK(ports.updates.empty());
  CHECK(server.counters().claims_drifted == 0);
}

TEST_CASE_METHOD(Fixture, "claims count for the newest view alone, and not for what was asked for",
                 "[world]") {
  join(2, 2);
  claim(2, kHere, {1, 1}, digest_at(*this, kHere));
  view(2, {{10, 0, 0}, 1, 0});
  time_us += 1'000'000;
  view(2, kSmall);
  CHECK(ports.messages<ChunksNotModified>(2, kEdge).empty());
  CHECK(snapshots_to(2).size() == 10);
  claim(2, kHere, {1, 1}, digest_at(*this, kHere));  // answered already: ignored
  server.received(2, ChunkRequest{{kHere}}, now());
  CHECK(ports.messages<ChunksNotModified>(2, kEdge).empty());
  CHECK(snapshots_to(2).size() == 11);
  CHECK(server.counters().chunks_requested == 1);
}

TEST_CASE_METHOD(Fixture, "what does not fit the queue is said later", "[world]") {
  join(2, 2);
  claim(2, kHere, {1, 1}, digest_at(*this, kHere));
  ports.full.insert(2);
  view(2, kSmall);
  tick();
  CHECK(ports.messages<ChunksNotModified>(2, kEdge).empty());
  ports.full.clear();
  server.drained(2, now());
  tick();
  CHECK(ports.messages<ChunksNotModified>(2, kEdge).size() == 1);
  CHECK(snapshots_to(2).size() == 4);
}

TEST_CASE_METHOD(Fixture, "the same is said before a session turns to the past", "[world]") {
  join(2, 2);
  claim(2, kHere, {1, 1}, digest_at(*this, kHere));
  server.received(2, View{{0, 0, 0}, 2, 0}, now());  // others have to be loaded: it waits for them
  CHECK(ports.messages<ChunksNotModified>(2, kEdge).empty());
  server.received(2, HistoryRequest{1, HistoryTarget::sequence, 0, 0}, now());
  server.moment_opened(2, 1, OpenedMoment{0, 0}, now());
  std::vector<std::string> order;
  for (const auto& sent : ports.sent) {
    if (sent.session != 2) continue;
    const auto message =
        decode_message(Sender::server, sent.message.frame_class, *sent.message.bytes, kEdge);
    REQUIRE(message.has_value());
    if (std::holds_alternative<ChunksNotModified>(*message)) order.emplace_back("same");
    if (std::holds_alternative<HistoryState>(*message)) order.emplace_back("moment");
  }
  CHECK(order == std::vector<std::string>{"same", "moment"});
}

}  // namespace runstone::test
