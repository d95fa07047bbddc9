// Edits of large actions: what waits, what is refused, and what a restart keeps.
#include "server/world/people/edit_requests.hpp"

#include "common/rights/role.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {
namespace {

constexpr std::uint64_t kLarge = kFeatureLargeActions;

WorldConfig limited(std::uint64_t per_second, std::uint64_t burst) {
  WorldConfig c = config();
  c.edit_budget = {per_second, burst};
  return c;
}

/// Players of large actions. An edit of the client sequence n sets a voxel at x = n.
struct ActionBench : WorldBench {
  explicit ActionBench(WorldConfig c = config(), const WorldStart& start = {})
      : WorldBench(std::move(c), start) {}

  void join_large(SessionId session, std::uint8_t who, ClientInstance instance = 1) {
    join(session, who, instance, {}, kLarge);
  }
  void send(SessionId session, ClientSequence seq, ClientSequence action, Material material = 1,
            bool is_optional = false) {
    EditRequest request{seq,
                        0,
                        {SetVoxel{{static_cast<std::int32_t>(seq), 1, 1}}, {}, material},
                        std::nullopt,
                        action};
    request.is_optional = is_optional;
    server.received(session, request, now());
  }
  std::vector<Reject> rejects(SessionId session) const {
    return environment.messages<Reject>(session, kEdge);
  }
  std::vector<ClientSequence> ordered() const {
    std::vector<ClientSequence> out;
    for (const EditRecord& record : environment.records) out.push_back(record.op.seq);
    return out;
  }
  std::vector<Sequence> subjects() const {
    std::vector<Sequence> out;
    for (const EditRecord& record : environment.records) out.push_back(record.subject);
    return out;
  }
};

constexpr Material kUnknownMaterial = 999;

}  // namespace

TEST_CASE("welcome tells the window of a session with large actions", "[world]") {
  ActionBench bench;
  bench.join_large(1, 1);
  bench.join(2, 2);
  const auto large = bench.environment.messages<Welcome>(1, 0).at(0);
  CHECK(large.features == kLarge);
  CHECK(large.waiting_edits_max == kWaitingEditsMax);
  CHECK(large.waiting_edit_bytes_max == kWaitingEditBytesMax);
  CHECK(bench.environment.messages<Welcome>(2, 0).at(0).waiting_edits_max == 0);
}

TEST_CASE("an action has more than 256 edits, and all name the first one", "[world][undo]") {
  ActionBench bench;
  bench.join_large(1, 1);
  for (ClientSequence seq = 1; seq <= 600; ++seq) bench.send(1, seq, 1);
  bench.server.commit(bench.now());
  REQUIRE(bench.environment.records.size() == 600);
  CHECK(bench.environment.records.front().subject == 0);
  CHECK(bench.environment.records.back().subject == 1);
}

TEST_CASE("a budget delays the edits of an action and rejects none", "[world]") {
  ActionBench bench(limited(10, 5));
  bench.join_large(1, 1);
  for (ClientSequence seq = 1; seq <= 25; ++seq) bench.send(1, seq, 1);
  CHECK(bench.server.people().edits().waiting() == 20);
  bench.send(1, 7, 1);  // offered again: it is not taken twice
  CHECK(bench.server.people().edits().waiting() == 20);
  bench.tick(1'000'000);
  CHECK(bench.environment.records.size() == 10);  // a second gives no more than the burst
  for (int i = 0; i < 20; ++i) bench.tick(100'000);
  CHECK(bench.rejects(1).empty());
  REQUIRE(bench.environment.records.size() == 25);
  for (ClientSequence seq = 1; seq <= 25; ++seq)
    CHECK(bench.environment.records[seq - 1].op.seq == seq);
  CHECK(bench.server.people().edits().waiting() == 0);
}

TEST_CASE("a click behind an action waits for its turn, and is then rejected if it must be",
          "[world]") {
  ActionBench bench(limited(1, 2));
  bench.join_large(1, 1);
  for (ClientSequence seq = 1; seq <= 3; ++seq) bench.send(1, seq, 1);
  bench.send(1, 4, 0);
  CHECK(bench.rejects(1).empty());
  bench.tick(1'000'000);
  CHECK(bench.ordered() == std::vector<ClientSequence>{1, 2, 3});
  REQUIRE(bench.rejects(1).size() == 1);
  CHECK(bench.rejects(1)[0].client_seq == 4);
  CHECK(bench.rejects(1)[0].reason == RejectReason::rate_limited);
}

TEST_CASE("without the feature, the budget rejects as before", "[world]") {
  ActionBench bench(limited(1, 2));
  bench.join(1, 1);
  for (ClientSequence seq = 1; seq <= 3; ++seq) bench.send(1, seq, 1);
  REQUIRE(bench.rejects(1).size() == 1);
  CHECK(bench.rejects(1)[0].reason == RejectReason::rate_limited);
  CHECK(bench.server.people().edits().waiting() == 0);
}

TEST_CASE("a log without room delays the edits of an action", "[world]") {
  ActionBench bench;
  bench.join_large(1, 1);
  bench.environment.log_room = false;
  bench.send(1, 1, 1);
  bench.send(1, 2, 1);
  bench.tick();
  CHECK(bench.rejects(1).empty());
  bench.environment.log_room = true;
  bench.tick();
  CHECK(bench.ordered() == std::vector<ClientSequence>{1, 2});
}

TEST_CASE("a full disk rejects the edits of an action as busy", "[world]") {
  ActionBench bench;
  bench.join_large(1, 1);
  bench.server.set_disk_is_full(true, bench.now());
  bench.send(1, 1, 1);
  REQUIRE(bench.rejects(1).size() == 1);
  CHECK(bench.rejects(1)[0].reason == RejectReason::busy);
}

TEST_CASE("a session with more edits under way than its window ends, with words", "[world]") {
  ActionBench bench(limited(1, 1));
  bench.join_large(1, 1);
  for (ClientSequence seq = 1; seq <= kWaitingEditsMax + 1; ++seq) bench.send(1, seq, 1);
  CHECK(bench.environment.closed.empty());
  bench.send(1, kWaitingEditsMax + 2, 1);
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::flooding);
  CHECK(
      bench.environment.closed[0].text ==
      "more than 128 edits, or 512 KiB of them, are under way: keep to waiting_edits_max of Welcome");
  CHECK(bench.server.people().edits().waiting() == 0);
}

TEST_CASE("an action goes on without an optional edit, and ends with another one", "[world]") {
  ActionBench bench;
  bench.join_large(1, 1);
  bench.send(1, 1, 1);
  bench.send(1, 2, 1, kUnknownMaterial, true);
  bench.send(1, 3, 1);
  bench.send(1, 4, 1, kUnknownMaterial);
  bench.send(1, 5, 1);
  bench.server.commit(bench.now());
  CHECK(bench.ordered() == std::vector<ClientSequence>{1, 3});
  CHECK(bench.subjects() == std::vector<Sequence>{0, 1});
  REQUIRE(bench.rejects(1).size() == 3);
  CHECK(bench.rejects(1)[2].client_seq == 5);
  CHECK(bench.rejects(1)[2].detail == "an earlier edit of the same action was refused");
}

TEST_CASE("the rest of an action whose first edit was rejected is refused", "[world]") {
  ActionBench bench;
  bench.join_large(1, 1);
  bench.send(1, 1, 1, kUnknownMaterial, true);
  bench.send(1, 2, 1);
  bench.send(1, 3, 3);
  bench.server.commit(bench.now());
  REQUIRE(bench.rejects(1).size() == 2);
  CHECK(bench.rejects(1)[1].reason == RejectReason::unknown_action);
  CHECK(bench.ordered() == std::vector<ClientSequence>{3});
}

TEST_CASE("clicks and other actions between the edits of an action do not end it",
          "[world][undo]") {
  ActionBench bench;
  bench.join_large(1, 1);
  bench.send(1, 1, 1);
  bench.send(1, 2, 0);
  bench.send(1, 3, 3);
  bench.send(1, 4, 1);
  bench.send(1, 5, 3);
  bench.server.commit(bench.now());
  CHECK(bench.subjects() == std::vector<Sequence>{0, 0, 0, 1, 3});
}

TEST_CASE("an action goes on after a reconnection and is found in the log after a restart",
          "[world][undo]") {
  ActionBench first;
  first.join_large(1, 1);
  first.send(1, 5, 5);
  first.send(1, 6, 5);
  first.server.disconnected(1);
  first.join_large(2, 1);
  first.send(2, 7, 5);
  first.server.commit(first.now());
  CHECK(first.subjects() == std::vector<Sequence>{0, 1, 1});

  WorldStart start;
  start.log.epoch = 2;
  start.log.last = 3;
  start.log.last_epoch = 1;
  start.players = first.environment.players;
  start.author_max = 1;
  start.resolved = {{1, 1, 7, 0}};
  ActionBench second(config(), start);
  second.join_large(1, 1);
  for (ClientSequence seq = 8; seq <= 10; ++seq) second.send(1, seq, 5);
  CHECK(second.environment.action_lookups == std::deque<OperationId>{{1, 1, 5}});
  CHECK(second.server.people().edits().waiting() == 3);
  second.tick();
  CHECK(second.environment.records.empty());
  SECTION("the log has it") {
    second.server.people().edits().action_found({1, 1, 5}, FoundAction{1, false}, second.now());
    second.tick();
    CHECK(second.subjects() == std::vector<Sequence>{1, 1, 1});
    second.send(1, 11, 5);
    second.tick();
    CHECK(second.environment.action_lookups.size() == 1);
  }
  SECTION("the log does not have it") {
    second.server.people().edits().action_found({1, 1, 5}, FoundAction{}, second.now());
    second.tick();
    REQUIRE(second.rejects(1).size() == 3);
    CHECK(second.rejects(1)[2].reason == RejectReason::unknown_action);
    second.send(1, 11, 11);
    second.tick();
    CHECK(second.subjects() == std::vector<Sequence>{0});
  }
  SECTION("its player has undone it") {
    second.server.people().edits().action_found({1, 1, 5}, FoundAction{1, true}, second.now());
    second.tick();
    REQUIRE(second.rejects(1).size() == 3);
    CHECK(second.rejects(1)[0].reason == RejectReason::action_ended);
  }
  SECTION("the log cannot be read at first") {
    second.server.people().edits().action_found({1, 1, 5}, std::nullopt, second.now());
    second.tick();
    CHECK(second.environment.action_lookups.size() == 1);
    second.tick(1'000'000);
    CHECK(second.environment.action_lookups.size() == 2);
    CHECK(second.rejects(1).empty());
  }
}

TEST_CASE("an action that was never ordered is unknown without a look-up", "[world]") {
  ActionBench bench;
  bench.join_large(1, 1);
  bench.send(1, 9, 4);
  REQUIRE(bench.rejects(1).size() == 1);
  CHECK(bench.rejects(1)[0].reason == RejectReason::unknown_action);
  CHECK(bench.environment.action_lookups.empty());
}

TEST_CASE("two large actions and twenty builders share the budgets and the turns", "[world]") {
  ActionBench bench(limited(20, 10));
  for (SessionId session = 1; session <= 22; ++session)
    bench.join_large(session, static_cast<std::uint8_t>(session));
  std::map<SessionId, ClientSequence> sent, acted;
  for (int turn = 0; turn < 200; ++turn) {
    for (SessionId session = 1; session <= 2; ++session) {
      while (sent[session] < acted[session] + kWaitingEditsMax)
        bench.send(session, ++sent[session], 1);
    }
    for (SessionId session = 3; session <= 22 && turn % 2 == 0; ++session)
      bench.send(session, ++sent[session], 0);
    bench.tick();
    acted.clear();
    for (const EditRecord& record : bench.environment.records) ++acted[record.op.author];
  }
  for (SessionId session = 1; session <= 22; ++session) {
    CAPTURE(session);
    CHECK(bench.rejects(session).empty());
  }
  // Ten seconds at 20 a second, and the first ten.
  CHECK(acted[1] == 210);
  CHECK(acted[2] == 210);
  for (SessionId session = 3; session <= 22; ++session) CHECK(acted[session] == 100);
}

TEST_CASE("one step decides about a bounded number of waiting edits", "[world]") {
  ActionBench bench;
  for (SessionId session = 1; session <= 3; ++session)
    bench.join_large(session, static_cast<std::uint8_t>(session));
  bench.environment.log_room = false;
  for (ClientSequence seq = 1; seq <= 100; ++seq) {
    for (SessionId session = 1; session <= 3; ++session) bench.send(session, seq, 1);
  }
  bench.environment.log_room = true;
  bench.tick();
  CHECK(bench.environment.records.size() == EditRequests::kEditsPerStep);
  std::map<AuthorId, int> of;
  for (const EditRecord& record : bench.environment.records) ++of[record.op.author];
  for (const auto& [author, count] : of) CHECK(std::abs(count - 21) <= 1);
  for (int i = 0; i < 5; ++i) bench.tick();
  CHECK(bench.environment.records.size() == 300);
}

TEST_CASE("a pending edit of before a repair that lost its watermark is not applied twice",
          "[world]") {
  WorldStart start;
  for (AuthorId author = 1; author <= 2; ++author)
    start.players.push_back({author,
                             key_pair_of(seed_of(static_cast<std::uint8_t>(author))).public_key,
                             "player" + std::to_string(author)});
  start.author_max = 2;
  start.resolved = {lost_watermarks(2, 1), {2, 5, 3, 0}};
  ActionBench bench(config(), start);
  const auto refused_twice = [&](SessionId session, ClientSequence seq) {
    bench.server.received(session, EditRequest{seq, 0, {SetVoxel{{1, 1, 1}}, {}, 1}}, bench.now());
    bench.server.received(session, EditRequest{seq + 1, 0, {SetVoxel{{2, 1, 1}}, {}, 1}},
                          bench.now());
    const auto rejects = bench.rejects(session);
    REQUIRE(rejects.size() == 2);
    for (const Reject& reject : rejects) {
      CHECK(reject.reason == RejectReason::not_permitted);
      CHECK(reject.detail ==
            "this world was repaired and does not know which of your edits it has: start your "
            "client again");
    }
  };
  bench.join(1, 1, 4);  // a client without a watermark, whose pending edits are 9 and 10
  refused_twice(1, 9);
  bench.join(2, 2, 5);  // one whose watermark may be too low
  refused_twice(2, 4);
  bench.join(3, 1, 6);  // the same player, who has started the client again
  for (ClientSequence seq = 1; seq <= 2; ++seq)
    bench.server.received(3, EditRequest{seq, 0, {SetVoxel{{3, 1, 1}}, {}, 1}}, bench.now());
  bench.join(4, 3, 7);  // a player who is newer than the repair
  bench.server.received(4, EditRequest{5, 0, {SetVoxel{{4, 1, 1}}, {}, 1}}, bench.now());
  bench.server.commit(bench.now());
  CHECK(bench.rejects(3).empty());
  CHECK(bench.rejects(4).empty());
  CHECK(bench.environment.records.size() == 3);
}

}  // namespace runstone::test
