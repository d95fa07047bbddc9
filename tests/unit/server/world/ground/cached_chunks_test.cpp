#include "server/world/ground/chunk_sending.hpp"

#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {
namespace {

const ChunkKey kHere{0, {0, 0, 0}};

std::uint64_t digest_at(const WorldBench& bench, const ChunkKey& key) {
  return claim_digest(bench.server.order().chunks().find(key)->digest);
}

/// A world with an edited chunk at the origin, version (epoch 1, seq 1), in memory. Session 1 is
/// subscribed to it.
struct Fixture : WorldBench {
  Fixture() {
    join(1, 1);
    view(1, kSmall);
    edit(1, 1, kAtOrigin);
    server.commit(now());
    server.durable(1, now());
    environment.snapshots.clear();
  }
  void claim(SessionId session, const ChunkKey& key, Version version, std::uint64_t digest) {
    server.received(session, CachedChunks{{{key, version, digest}}}, now());
  }
  std::vector<ChunkKey> snapshots_to(SessionId session) const {
    std::vector<ChunkKey> keys;
    for (const auto& sent : environment.snapshots) {
      if (sent.session == session) keys.push_back(sent.key);
    }
    return keys;
  }
};

}  // namespace

TEST_CASE_METHOD(
    Fixture,
    "a copy with the chunk's version and digest is answered by not modified and subscribed",
    "[world]") {
  join(2, 2);
  claim(2, kHere, {1, 1}, digest_at(*this, kHere));
  view(2, kSmall);
  const auto same = environment.messages<ChunksNotModified>(2, kEdge);
  REQUIRE(same.size() == 1);
  CHECK(same[0] == ChunksNotModified{1, {{kHere, 1}}});
  CHECK(snapshots_to(2).size() == 4);
  CHECK(server.counters().not_modified_sent == 1);
  edit(1, 2, kAtOrigin, 2);
  server.commit(now());
  CHECK(commits(2).size() == 1);
}

TEST_CASE_METHOD(Fixture,
                 "a copy with another digest at the same version gets a snapshot, and is counted",
                 "[world]") {
  join(2, 2);
  claim(2, kHere, {1, 1}, digest_at(*this, kHere) ^ 1);
  view(2, kSmall);
  CHECK(environment.messages<ChunksNotModified>(2, kEdge).empty());
  CHECK(snapshots_to(2).size() == 5);
  CHECK(server.counters().claims_drifted == 1);
}

TEST_CASE_METHOD(Fixture,
                 "a copy at an earlier version gets an update when the edits between are on disk",
                 "[world]") {
  const std::uint64_t digest = digest_at(*this, kHere);
  edit(1, 2, kAtOrigin, 2);
  server.commit(now());
  join(2, 2);
  claim(2, kHere, {1, 1}, digest);
  view(2, kSmall);
  CHECK(environment.updates.empty());  // sequence 2 is not durable, so no reader has it
  CHECK(snapshots_to(2).size() == 5);
  server.durable(2, now());
  join(3, 3);
  claim(3, kHere, {1, 1}, digest);
  view(3, kSmall);
  REQUIRE(environment.updates.size() == 1);
  CHECK(environment.updates[0] == std::pair(kHere, Version{1, 1}));
  CHECK(server.order().chunks().version(kHere) == Version{1, 2});
  CHECK(server.counters().updates_sent == 1);
  edit(1, 3, kAtOrigin, 3);  // the session is subscribed since the update
  server.commit(now());
  CHECK(commits(3).size() == 1);
}

TEST_CASE_METHOD(Fixture, "a copy at a version that this server never had gets a snapshot",
                 "[world]") {
  SessionId session = 2;
  for (const Version version : {Version{1, 2}, Version{7, 900}, Version{7, 0}}) {
    join(session, static_cast<std::uint8_t>(session));
    claim(session, kHere, version, digest_at(*this, kHere));
    view(session, kSmall);
    CHECK(snapshots_to(session).size() == 5);
    ++session;
  }
  CHECK(environment.updates.empty());
  CHECK(server.counters().claims_drifted == 0);
}

TEST_CASE_METHOD(Fixture,
                 "only claims inside of the newest view count, and none for requested chunks",
                 "[world]") {
  join(2, 2);
  claim(2, kHere, {1, 1}, digest_at(*this, kHere));
  view(2, {1, {10, 0, 0}, 1, 0});
  time_us += 1'000'000;
  view(2, kSmall);
  CHECK(environment.messages<ChunksNotModified>(2, kEdge).empty());
  CHECK(snapshots_to(2).size() == 10);
  claim(2, kHere, {1, 1}, digest_at(*this, kHere));  // ignored, because the chunk was sent already
  server.received(2, ChunkRequest{{kHere}}, now());
  CHECK(environment.messages<ChunksNotModified>(2, kEdge).empty());
  CHECK(snapshots_to(2).size() == 11);
  CHECK(server.counters().chunks_requested == 1);
}

TEST_CASE_METHOD(Fixture, "answers that do not fit the queue are sent later", "[world]") {
  join(2, 2);
  claim(2, kHere, {1, 1}, digest_at(*this, kHere));
  environment.full.insert(2);
  view(2, kSmall);
  tick();
  CHECK(environment.messages<ChunksNotModified>(2, kEdge).empty());
  environment.full.clear();
  server.drained(2, now());
  tick();
  CHECK(environment.messages<ChunksNotModified>(2, kEdge).size() == 1);
  CHECK(snapshots_to(2).size() == 4);
}

TEST_CASE_METHOD(Fixture, "not modified is sent before a session goes to the past", "[world]") {
  join(2, 2);
  claim(2, kHere, {1, 1}, digest_at(*this, kHere));
  send_view(2, View{1, {0, 0, 0}, 2, 0});  // the answer waits for other chunks that load
  CHECK(environment.messages<ChunksNotModified>(2, kEdge).empty());
  server.received(2, HistoryRequest{1, HistoryTarget::sequence, 0, 0}, now());
  server.ground().history_opened(2, 1, OpenedHistory{0, 0}, now());
  std::vector<std::string> order;
  for (const auto& sent : environment.sent) {
    if (sent.session != 2) continue;
    if (sent.message.kind == kKindOf<ChunksNotModified>) order.emplace_back("same");
    if (sent.message.kind == kKindOf<ViewState>) order.emplace_back("state");
  }
  CHECK(order == std::vector<std::string>{"same", "state"});
}

/// A session that claims all chunks of a wide view, which are in memory and unchanged.
struct WideClaims : WorldBench {
  static constexpr View kWide{1, {0, 0, 0}, 16, 6};

  static WorldConfig wide_config() {
    WorldConfig c = config();
    c.view_radius_max = 16;
    return c;
  }
  WideClaims() : WorldBench(wide_config()) {
    has_empty_base = true;
    join(1, 1);
    view(1, kWide);
    for (std::int32_t x = -16; x <= 16; ++x) {
      for (std::int32_t y = -6; y <= 6; ++y) {
        for (std::int32_t z = -16; z <= 16; ++z) {
          const ChunkKey key{0, {x, y, z}};
          if (!kWide.contains(key.at)) continue;
          const ChunkPtr chunk = server.order().chunks().find(key);
          claims.push_back({key, chunk->version, claim_digest(chunk->digest)});
        }
      }
    }
    join(2, 2);
    for (Message& message : cached_chunks_messages(claims))
      server.received(2, std::move(message), now());
  }
  std::vector<ChunksNotModified> answers() const {
    return environment.messages<ChunksNotModified>(2, kEdge);
  }

  std::vector<CachedChunk> claims;
};

TEST_CASE_METHOD(WideClaims, "a task answers a bounded number of claims", "[world]") {
  REQUIRE(claims.size() > 10'000);
  environment.full.insert(2);
  send_view(2, kWide);
  std::uint64_t answered = server.counters().not_modified_sent;
  CHECK(answered <= 512);
  while (server.ground().has_deliveries()) {
    server.ground().deliver_next(now());
    const std::uint64_t now_answered = server.counters().not_modified_sent;
    REQUIRE(now_answered - answered <= 512);
    answered = now_answered;
  }
  CHECK(answered == claims.size());
  CHECK(answers().empty());

  // All answers are due when the queue has room again. A task sends a few messages of them.
  environment.full.clear();
  server.drained(2, now());
  std::size_t sent = answers().size();
  CHECK(sent == kNotModifiedPerCall);
  int tasks = 1;
  for (; server.ground().has_deliveries(); ++tasks) {
    server.ground().deliver_next(now());
    const std::size_t now_sent = answers().size();
    REQUIRE(now_sent - sent <= kNotModifiedPerCall);
    sent = now_sent;
  }
  CHECK(tasks >= 3);
  std::set<ChunkKey> keys;
  for (const ChunksNotModified& message : answers()) {
    for (const UnmodifiedChunk& chunk : message.chunks) CHECK(keys.insert(chunk.key).second);
  }
  CHECK(keys.size() == claims.size());
}

TEST_CASE_METHOD(WideClaims, "answers of several tasks precede the past", "[world]") {
  environment.full.insert(2);
  send_view(2, kWide);
  while (server.ground().has_deliveries()) server.ground().deliver_next(now());
  environment.full.clear();
  server.received(2, HistoryRequest{1, HistoryTarget::sequence, 0, 0}, now());
  server.ground().history_opened(2, 1, OpenedHistory{0, 0}, now());
  CHECK(answers().size() == kNotModifiedPerCall);
  CHECK(environment.messages<ViewState>(2, kEdge).empty());
  while (server.ground().has_deliveries()) server.ground().deliver_next(now());
  CHECK(answers().size() == (claims.size() + kChunksNotModifiedMax - 1) / kChunksNotModifiedMax);
  CHECK_FALSE(environment.messages<ViewState>(2, kEdge).empty());
}

TEST_CASE_METHOD(WideClaims, "a view costs its session reading for the claims that wait",
                 "[world]") {
  CHECK(environment.charged[2] == 0);
  environment.full.insert(2);
  send_view(2, kWide);
  CHECK(environment.charged[2] == claims.size() / 8);
  while (server.ground().has_deliveries()) server.ground().deliver_next(now());
  send_view(2, kWide);  // all claims are answered
  CHECK(environment.charged[2] == claims.size() / 8);
}

}  // namespace runstone::test
