#include "server/world/commit/commits.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "tests/unit/server/world/commit/pasted_crowd.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone {
namespace {

using namespace test;
using Bench = WorldBench;

TEST_CASE("a commit is sent to every session that sees its chunk, and to its author", "[world]") {
  Bench bench;
  for (SessionId s = 1; s <= 4; ++s) bench.join(s, static_cast<std::uint8_t>(s));
  bench.view(1, kSmall);
  bench.view(2, kSmall);
  bench.view(3, {1, {50, 0, 0}, 1, 0});  // far away
  bench.edit(4, 1, kAtOrigin, 3);        // sees nothing at all
  CHECK(bench.commits(1).empty());
  const std::size_t before = bench.environment.sent.size();
  bench.server.commit(bench.now());
  for (const SessionId s : {1U, 2U, 4U}) {
    const auto commits = bench.commits(s);
    REQUIRE(commits.size() == 1);
    CHECK(commits[0].edits.at(0).seq == 1);
    CHECK(commits[0].edits.at(0).op == OperationId{4, 1, 1});
    CHECK(commits[0].edits[0].previous == std::vector<Sequence>{0});
  }
  CHECK(bench.commits(3).empty());
  // All receivers get the same bytes.
  std::set<const Bytes*> bytes;
  for (std::size_t i = before; i < bench.environment.sent.size(); ++i) {
    const EncodedMessage& message = bench.environment.sent[i].message;
    if (class_of(message) == FrameClass::edits) bytes.insert(message.bytes.get());
  }
  CHECK(bytes.size() == 1);
  REQUIRE(bench.environment.records.size() == 1);
  CHECK(bench.environment.players.size() == 1);  // only players who edit get a row
  CHECK(bench.environment.players[0].author == 4);
}

TEST_CASE("large edits that many see are sent at a bounded rate, small edits at once", "[world]") {
  constexpr ClientSequence kPastes = 40;
  PastedCrowd bench(kPastes);
  const auto paste_count = [&] { return bench.environment.records.size(); };
  CHECK_FALSE(bench.server.has_ready_edits(bench.now().steady_us));
  const std::size_t burst = paste_count();
  CHECK(burst >= 1);
  CHECK(burst <= 4);  // 2 MB each
  bench.edit(2, 1, kAtOrigin);
  bench.server.commit(bench.now());
  CHECK(paste_count() == burst + 1);
  CHECK(bench.environment.records.back().op.author == 2);
  bench.edit(1, kPastes + 1, kAtOrigin);
  bench.server.commit(bench.now());
  CHECK(paste_count() == burst + 1);          // it waits behind the pastes of its client
  for (int i = 0; i < 20; ++i) bench.tick();  // a second
  CHECK(paste_count() > burst + 1);
  CHECK(paste_count() <= burst + 1 + 5);
  bench.server.begin_stop(bench.now());
  CHECK(paste_count() == kPastes + 2);  // a stop orders all that was accepted
}

TEST_CASE("large edits that wait are not ordered while another server may own the world",
          "[world]") {
  PastedCrowd bench(40);
  const std::size_t burst = bench.environment.records.size();
  bench.environment.is_owner = false;
  for (int i = 0; i < 100; ++i) bench.tick();
  CHECK(bench.environment.records.size() == burst);
  CHECK_FALSE(bench.server.has_ready_edits(bench.now().steady_us));
  bench.environment.is_owner = true;
  for (int i = 0; i < 20; ++i) bench.tick();
  CHECK(bench.environment.records.size() > burst);
}

TEST_CASE("of a commit, a session gets the edits that it sees or made, and no others", "[world]") {
  Bench bench;
  const SetVoxel far_away{{50 * 16 + 1, 1, 1}};
  for (SessionId s = 1; s <= 4; ++s) bench.join(s, static_cast<std::uint8_t>(s));
  bench.view(1, kSmall);
  bench.view(2, kSmall);
  bench.view(3, {1, {50, 0, 0}, 1, 0});
  bench.edit(1, 1, far_away);   // sequence 1
  bench.edit(2, 1, kAtOrigin);  // 2
  bench.edit(4, 1, kAtOrigin);  // 3
  bench.server.commit(bench.now());
  const auto sequences = [&](SessionId session) {
    std::vector<Sequence> out;
    for (const Commit& commit : bench.commits(session))
      for (const OrderedEdit& edit : commit.edits) out.push_back(edit.seq);
    return out;
  };
  CHECK(sequences(1) == std::vector<Sequence>{1, 2, 3});  // it made the one far away
  CHECK(sequences(2) == std::vector<Sequence>{2, 3});
  CHECK(sequences(3) == std::vector<Sequence>{1});
  CHECK(sequences(4) == std::vector<Sequence>{3});
}

TEST_CASE("edits that nobody sees and whose author has left are ordered and sent to nobody",
          "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.join(2, 2);
  bench.edit(1, 1, kAtOrigin);
  bench.server.disconnected(1);
  const std::size_t before = bench.environment.sent.size();
  bench.server.commit(bench.now());
  CHECK(bench.server.order().head() == 1);
  CHECK(bench.environment.sent.size() == before);
  CHECK(bench.environment.records.size() == 1);
}

TEST_CASE("edits that are queued together are one commit, and a later snapshot contains it",
          "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.server.received(1, kSmall, bench.now());  // loads are requested and not answered
  for (ClientSequence seq = 1; seq <= 10; ++seq) bench.edit(1, seq, kAtOrigin, 1 + seq % 4);
  bench.server.commit(bench.now());
  CHECK(bench.commits(1).size() == 1);
  bench.answer_loads();
  for (const auto& s : bench.environment.snapshots) {
    if (s.key == ChunkKey{}) CHECK(s.chunk->version == Version{1, 10});
  }
  bench.edit(1, 11, kAtOrigin);
  bench.server.commit(bench.now());
  CHECK(bench.commits(1).size() == 2);
}

TEST_CASE("a watermark that rose while a session opened is sent to it, also without new edits",
          "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.edit(1, 1, kAtOrigin);
  bench.server.commit(bench.now());
  const Hello hello = bench.hello(2);
  bench.server.connected(2, bench.now());
  bench.server.received(2, hello, bench.now());
  const auto welcome = bench.environment.messages<Welcome>(2, 0);
  REQUIRE(welcome.size() == 1);
  CHECK(welcome[0].durable == 0);
  bench.server.durable(1, bench.now());
  bench.server.received(2, bench.client_auth(2, hello, welcome[0]), bench.now());
  bench.tick();
  const auto watermarks = bench.environment.messages<Durable>(2, kEdge);
  REQUIRE(watermarks.size() == 1);
  CHECK(watermarks[0].seq == 1);
  bench.join(3, 3);  // its welcome has the watermark
  bench.tick();
  CHECK(bench.environment.messages<Durable>(3, kEdge).empty());
}

TEST_CASE("the durable watermark goes to the authors of edits at once, and again if it did not fit",
          "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.join(2, 2);
  bench.join(3, 3);
  bench.tick();  // every session has the watermark
  bench.edit(1, 1, kAtOrigin);
  bench.edit(2, 1, kAtOrigin);
  bench.server.commit(bench.now());
  bench.environment.full.insert(2);
  bench.environment.rounds.clear();
  bench.server.durable(2, bench.now());
  // Both authors are in one round.
  using Round = std::pair<MessageKind, std::size_t>;
  CHECK(bench.environment.rounds == std::vector<Round>{{kKindOf<Durable>, 2}});
  bench.server.durable(2, bench.now());  // nothing new
  CHECK(bench.environment.messages<Durable>(1, kEdge).size() == 1);
  CHECK(bench.environment.messages<Durable>(2, kEdge).empty());
  bench.environment.full.clear();
  bench.tick();
  const auto later = bench.environment.messages<Durable>(2, kEdge);
  REQUIRE(later.size() == 1);
  CHECK(later[0].seq == 2);
  CHECK(later[0].epoch == 1);
  // A session without edits under way gets it once a second.
  CHECK(bench.environment.messages<Durable>(3, kEdge).empty());
  bench.tick(1'000'000);
  bench.tick(1'000'000);
  CHECK(bench.environment.messages<Durable>(1, kEdge).size() == 1);
  CHECK(bench.environment.messages<Durable>(3, kEdge).size() == 1);
}

TEST_CASE("an edit offered again is acknowledged as durable at once, also in a new session",
          "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.tick();
  bench.edit(1, 1, kAtOrigin);
  bench.server.commit(bench.now());
  bench.server.disconnected(1);
  bench.join(2, 1);
  bench.edit(2, 1, kAtOrigin);
  REQUIRE(bench.environment.messages<Reject>(2, kEdge).at(0).reason ==
          RejectReason::already_resolved);
  bench.server.durable(1, bench.now());
  CHECK(bench.environment.messages<Durable>(2, kEdge).size() == 1);
}

TEST_CASE("a full session loses commits, later gets snapshots, and an answer for each edit it made",
          "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.view(1, kSmall);
  CHECK(bench.environment.snapshots.size() == 5);
  bench.edit(1, 1, kAtOrigin, 2);
  bench.environment.snapshot_room[1] = 0;
  bench.environment.refuse_edits.insert(1);
  bench.server.commit(bench.now());
  CHECK(bench.commits(1).empty());
  CHECK(bench.server.counters().chunks_stale == 1);
  CHECK(bench.environment.messages<Reject>(1, kEdge)
            .empty());  // the answer is pending, because answers keep the order of commits
  // A session gets no commits of a stale chunk, and no snapshot before its queue has room.
  bench.environment.refuse_edits.clear();
  bench.tick(0);
  const auto rejects = bench.environment.messages<Reject>(1, kEdge);
  REQUIRE(rejects.size() == 1);
  CHECK(rejects[0].reason == RejectReason::already_resolved);
  bench.edit(1, 2, SetVoxel{{20, 1, 1}}, 2);  // the chunk to the east is still subscribed
  bench.server.commit(bench.now());
  CHECK(bench.commits(1).size() == 1);
  bench.tick(200'000);
  CHECK(bench.environment.snapshots.size() == 5);
  bench.environment.snapshot_room[1] = 100;
  bench.server.drained(1, bench.now());
  REQUIRE(bench.environment.snapshots.size() == 6);
  CHECK(bench.environment.snapshots[5].key == ChunkKey{});
  CHECK(bench.environment.snapshots[5].chunk->version == Version{1, 1});
}

TEST_CASE("answers that do not fit are sent later in order, and too many close the session",
          "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.environment.full.insert(1);
  for (ClientSequence seq = 1; seq <= 3; ++seq) bench.edit(1, seq, kAtOrigin, 99);
  CHECK(bench.environment.closed.empty());
  bench.environment.full.clear();
  bench.edit(1, 4, kAtOrigin, 99);
  bench.server.drained(1, bench.now());
  const auto rejects = bench.environment.messages<Reject>(1, kEdge);
  REQUIRE(rejects.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) CHECK(rejects[i].client_seq == i + 1);
  bench.environment.full.insert(1);
  for (ClientSequence seq = 5; seq <= 5000 && bench.environment.closed.empty(); ++seq) {
    bench.edit(1, seq, kAtOrigin, 99);
  }
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::timed_out);
}

TEST_CASE("a session may be closed by the answers to a commit that did not fit its queue",
          "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.join(2, 2);
  bench.environment.full.insert(1);
  ClientSequence seq = 0;
  while (seq < 4096) bench.edit(1, ++seq, kAtOrigin, 99);  // as many answers as may be pending
  REQUIRE(bench.environment.closed.empty());
  for (int i = 0; i < 3; ++i) bench.edit(1, ++seq, kAtOrigin);
  bench.edit(2, 1, kAtOrigin);
  bench.server.commit(bench.now());
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].session == 1);
  CHECK(bench.server.order().head() == 4);
  CHECK(bench.commits(2).size() == 1);
  CHECK(bench.commits(1).empty());
}

}  // namespace
}  // namespace runstone
