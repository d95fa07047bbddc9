// The owner of a world hands it over to a server that follows, and follows that server.
#include "server/world/cluster/handover.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/server/world/cluster/cluster_bench.hpp"

namespace runstone::test {
namespace {

/// Lets the owner hand the world over to this follower, up to the moment when it has given up the lease.
void begin_handover(ClusterBench& bench, std::size_t successor) {
  WorldServer& world = bench.world(bench.owner);
  const SessionId link = bench.servers[successor].link;
  REQUIRE(world.cluster().handover_refusal(link) == std::nullopt);
  CHECK(world.cluster().hand_over(link, bench.now()) == link);
  CHECK(world.cluster().is_following());
  bench.run();
  CHECK(bench.database.last() == world.order().head());
  CHECK(world.order().durable() == world.order().head());
  world.cluster().handover_written(bench.now());
  CHECK_FALSE(bench.servers[successor].owner);  // its connection has ended
}

/// Lets the successor take the world over, and the former owner follow it.
void end_handover(ClusterBench& bench, std::size_t successor) {
  const std::size_t former = bench.owner;
  REQUIRE(bench.take_over(successor));
  bench.connect(former);
  bench.run();
  CHECK(bench.world(former).cluster().is_live());
  CHECK(bench.world(former).order().epoch() == bench.database.epoch);
  for (std::size_t i = 0; i < bench.servers.size(); ++i) {
    if (i == successor || i == former) continue;
    CHECK_FALSE(bench.servers[i].owner);  // it looks for the new owner now
    bench.connect(i);
  }
  for (int i = 0; i < 3; ++i) bench.tick();
}

/// Checks that each edit of this client is in the log once, in order, up to `count`.
void check_once(const ClusterBench& bench, AuthorId author, ClientSequence count) {
  CAPTURE(author);
  std::vector<ClientSequence> found, expected;
  for (const EditRecord& record : bench.database.records) {
    if (record.op.author == author) found.push_back(record.op.seq);
  }
  for (ClientSequence seq = 1; seq <= count; ++seq) expected.push_back(seq);
  CHECK(found == expected);
}

TEST_CASE("a server that took the world over while it read the log reads again as a follower",
          "[world][servers]") {
  ClusterBench bench(1);
  bench.join(1, 1, 1);
  bench.edit(1, 1, 1, block(1));
  bench.run();
  const std::size_t late = bench.add_follower();
  bench.edit(1, 1, 2, block(2));
  bench.run();
  bench.servers[late].holds_reads = true;
  bench.connect(late);
  bench.pump();
  REQUIRE(bench.environment(late).missed_log_reads.size() == 1);
  bench.lose_owner();
  REQUIRE(bench.take_over(late));
  bench.servers[late].holds_reads = false;
  bench.run();  // the answer comes now
  REQUIRE(bench.environment(late).missed_log_reads.empty());
  bench.connect(1);
  for (int i = 0; i < 3; ++i) bench.tick();
  begin_handover(bench, 1);
  end_handover(bench, 1);
  bench.cut(late);
  bench.edit(1, 1, 3, block(3));
  bench.run();
  bench.connect(late);
  for (int i = 0; i < 10 && !bench.world(late).cluster().is_live(); ++i) bench.tick();
  CHECK(bench.world(late).cluster().is_live());
  CHECK(bench.world(late).order().head() == bench.world(1).order().head());
}

TEST_CASE("an owner hands the world over and back, and each edit is applied once",
          "[world][servers]") {
  ClusterBench bench(2);
  std::vector<AuthorId> authors;
  for (std::size_t i = 0; i < 3; ++i) {
    authors.push_back(bench.join(i, 1, static_cast<std::uint8_t>(i + 1)).author);
    bench.at(i).view(1, kSmall);
  }
  ClientSequence seq = 0;
  std::int32_t x = 0;
  const auto edit_everywhere = [&] {
    ++seq;
    for (std::size_t i = 0; i < 3; ++i) bench.edit(i, 1, seq, block(x++ % 16));
  };
  std::vector<std::size_t> owners{1, 0, 2, 0};
  for (std::size_t round = 0; round < owners.size(); ++round) {
    CAPTURE(round);
    edit_everywhere();
    bench.run();
    edit_everywhere();
    bench.pump();  // they are queued at the owner
    const std::size_t former = bench.owner;
    begin_handover(bench, owners[round]);
    CHECK(bench.world(former).order().head() == 3 * seq);
    edit_everywhere();  // they are ignored everywhere
    bench.pump();
    CHECK(bench.world(former).order().head() == 3 * (seq - 1));
    CHECK(bench.world(former).order().resolved(authors[former], 1) == seq - 1);
    end_handover(bench, owners[round]);
    CHECK(bench.world(bench.owner).order().epoch() == round + 2);
    CHECK(bench.world(bench.owner).order().head() == 3 * seq);
    CHECK(bench.world(bench.owner).people().online().size() == 3);
    edit_everywhere();
    bench.run();
  }
  for (std::size_t i = 0; i < 3; ++i) {
    CAPTURE(i);
    check_once(bench, authors[i], seq);
    CHECK_FALSE(bench.end_of(i, 1).has_value());
    CHECK(bench.sent<SessionAccepted>(i, 1).size() == 1);
    CHECK(bench.sent<Resume>(i, 1).size() == owners.size());
    CHECK(bench.sent<Reject>(i, 1).empty());
    CHECK(bench.unanswered(i, 1).empty());
    std::vector<Sequence> all;
    for (Sequence each = 1; each <= 3 * seq; ++each) all.push_back(each);
    CHECK(bench.sequences(i, 1) == all);
    CHECK(bench.world(i).order().last_record() ==
          Version{static_cast<Epoch>(owners.size() + 1), 3 * seq});
    bench.check_same_chunks(0, i);
  }
  // A line, a command and a new player find the owner.
  bench.time_us += 1'000'000;
  bench.receive(1, 1, ChatRequest{"still here"});
  bench.receive(1, 1, CommandRequest{5, "players"});
  bench.tick();
  CHECK(bench.sent<ChatLines>(2, 1).back().lines.back().text == "still here");
  CHECK(bench.environment(0).commands == std::vector<std::string>{"players"});
  bench.join(2, 9, 9);
}

TEST_CASE(
    "a server that hands the world over orders large edits that wait, and sends waiting lines",
    "[world][servers]") {
  WorldConfig c = config();
  c.edit_volume_max = 1'000'000'000;
  ClusterBench bench(1, c);
  const AuthorId author = bench.join(0, 1, 1).author;
  bench.join(1, 1, 2);
  for (ClientSequence seq = 1; seq <= 6; ++seq)
    bench.edit(0, 1, seq, FillBox{{{0, 0, 0}, {600, 15, 600}}});
  bench.receive(1, 1, ChatRequest{"one more line"});
  bench.pump();
  begin_handover(bench, 1);
  CHECK(bench.world(0).order().head() == 6);
  REQUIRE_FALSE(bench.sent<ChatLines>(1, 1).empty());
  CHECK(bench.sent<ChatLines>(1, 1).back().lines.back().text == "one more line");
  end_handover(bench, 1);
  check_once(bench, author, 6);
}

TEST_CASE("a former owner that owns the world again does not save the spawn that it set before",
          "[world][servers]") {
  ClusterBench bench(1);
  bench.join(0, 1, 1);
  bench.world(0).set_spawn({1, 2, 3}, bench.now());
  REQUIRE_FALSE(bench.environment(0).states.empty());
  CHECK(bench.environment(0).states.back().spawn == WorldPos{1, 2, 3});
  begin_handover(bench, 1);
  end_handover(bench, 1);
  bench.world(1).set_spawn({4, 5, 6}, bench.now());
  begin_handover(bench, 0);
  end_handover(bench, 0);
  bench.world(0).save_state(bench.now());
  CHECK(bench.environment(0).states.back().spawn == std::nullopt);
}

TEST_CASE("an owner refuses to hand the world over when nobody can take it, and says why",
          "[world][servers]") {
  ClusterBench alone(0);
  CHECK(alone.world(0).cluster().handover_refusal({}) == "no other server follows this one");
  ClusterBench bench;
  const SessionId link = bench.servers[1].link;
  CHECK(bench.world(0).cluster().handover_refusal({}) == std::nullopt);
  CHECK(bench.world(0).cluster().handover_refusal(link) == std::nullopt);
  CHECK(bench.world(0).cluster().handover_refusal(link + 1) ==
        "no server " + std::to_string(link + 1) + " follows this one (servers lists them)");
  CHECK(bench.world(1).cluster().handover_refusal({}) == "this server does not own the world");
  bench.environment(0).is_owner = false;
  CHECK(bench.world(0).cluster().handover_refusal({}) ==
        "the database does not answer: another server may own the world");
  bench.environment(0).is_owner = true;
  bench.world(0).set_disk_is_full(true, bench.now());
  CHECK(bench.world(0).cluster().handover_refusal({}) == "the world's disk is full or read-only");
  bench.world(0).set_disk_is_full(false, bench.now());
  bench.world(0).log_failed();
  CHECK(bench.world(0).cluster().handover_refusal({}) ==
        "the server stops, or its log cannot be written");
}

TEST_CASE("an owner knows the servers of the world, and chooses the one with the most players",
          "[world][servers]") {
  WorldConfig c = config();
  c.player_address = "server";
  c.heights = {-10, 10};
  ClusterBench bench(3, c);
  bench.join(0, 1, 1);
  bench.join(1, 1, 2);
  bench.join(2, 1, 3);
  bench.join(2, 2, 4);
  bench.join(3, 1, 5);
  bench.join(3, 2, 6);
  bench.edit(0, 1, 1, block(1));
  bench.edit(2, 1, 1, block(2));
  bench.edit(2, 2, 1, block(3));
  bench.edit(2, 2, 2, SetVoxel{{0, 11, 0}});  // refused
  bench.run();
  const auto servers = bench.world(0).cluster().known_servers();
  REQUIRE(servers.size() == 4);
  CHECK(servers[0].link == std::nullopt);
  CHECK(servers[0].player_address == "server0:4747");
  CHECK(servers[0].players == 1);
  CHECK(servers[0].edits == 1);
  CHECK(servers[2].link == bench.servers[2].link);
  CHECK(servers[2].player_address == "server2:4747");
  CHECK(servers[2].players == 2);
  CHECK(servers[2].edits == 2);
  CHECK(servers[3].players == 2);
  CHECK(bench.world(0).cluster().hand_over({}, bench.now()) ==
        bench.servers[2].link);  // the first of two
}

TEST_CASE(
    "other followers stay connected, and are ignored, until there is an owner or a second is over",
    "[world][servers]") {
  ClusterBench bench(2);
  bench.join(0, 1, 1);
  bench.join(2, 1, 3);
  begin_handover(bench, 1);
  CHECK(bench.world(2).cluster().is_live());
  REQUIRE(bench.world(2).cluster().owner_heard_us().has_value());
  bench.knock(2, 2, 4, bench.hello(4));
  bench.edit(2, 1, 1, block(1));
  bench.receive(2, 1, Move{Pose{{1, 2, 3}, 0, 0}});
  bench.world(2).disconnected(1);
  bench.pump();
  CHECK_FALSE(bench.is_open(2, 2));
  CHECK(bench.world(0).people().online().size() == 1);
  CHECK(bench.world(0).cluster().follower_count() == 1);
  bench.tick(900'000);
  CHECK(bench.world(2).cluster().is_live());
  bench.tick(150'000);
  CHECK_FALSE(bench.world(2).cluster().is_live());
  CHECK(bench.world(2).cluster().owner_heard_us() == std::nullopt);
  CHECK(bench.world(0).cluster().follower_count() == 0);
  // Another server than the chosen one takes the world over, and everybody goes on.
  REQUIRE(bench.take_over(2));
  bench.run();
  CHECK(bench.is_open(2, 2));
  bench.connect(0);
  bench.connect(1);
  bench.tick();
  CHECK(bench.world(0).cluster().is_live());
  CHECK(bench.world(1).cluster().is_live());
}

TEST_CASE("a former owner that owns the world again lets its other followers connect anew",
          "[world][servers]") {
  ClusterBench bench(2);
  bench.join(0, 1, 1);
  bench.join(2, 1, 3);
  begin_handover(bench, 1);
  CHECK(bench.world(2).cluster().is_live());
  REQUIRE(bench.take_over(0));  // the successor is gone
  bench.run();
  CHECK_FALSE(bench.world(2).cluster().is_live());
  bench.connect(2);
  bench.edit(0, 1, 1, block(1));
  bench.edit(2, 1, 1, block(2));
  for (int i = 0; i < 3; ++i) bench.tick();
  CHECK(bench.world(2).cluster().is_live());
  CHECK(bench.world(0).order().head() == 2);
  CHECK(bench.world(2).order().head() == 2);
}

TEST_CASE("other followers hear that the last edits are durable, and do not read them",
          "[world][servers]") {
  ClusterBench bench(2);
  bench.join(0, 1, 1);
  bench.edit(0, 1, 1, block(1));
  bench.pump();  // it is ordered, and not durable
  begin_handover(bench, 1);
  CHECK(bench.world(2).order().durable() == 1);
  bench.servers[2].holds_reads = true;
  end_handover(bench, 1);
  CHECK(bench.world(2).cluster().is_live());
}

TEST_CASE("a server that takes a world over offers what it offered as its owner before",
          "[world][servers]") {
  WorldConfig c = config();
  c.features &= ~kFeatureTiles;
  ClusterBench bench(1, c);
  const auto offered = [&](std::size_t server, SessionId session, std::uint8_t who) {
    bench.join(server, session, who);
    return bench.sent<Welcome>(server, session).at(0).features;
  };
  const std::uint64_t of_owner = offered(0, 1, 1);
  CHECK((of_owner & kFeaturesOfOwner) == kFeaturesOfOwner);
  CHECK((of_owner & kFeatureTiles) == 0);
  CHECK(offered(1, 1, 2) == (of_owner & ~kFeaturesOfOwner));
  begin_handover(bench, 1);
  end_handover(bench, 1);
  CHECK(offered(0, 2, 3) == (of_owner & ~kFeaturesOfOwner));
  CHECK(offered(1, 2, 4) == of_owner);
}

TEST_CASE("a follower hears its owner as long as the owner answers", "[world][servers]") {
  ClusterBench bench;
  CHECK(bench.world(0).cluster().owner_heard_us() == std::nullopt);  // it has none
  REQUIRE(bench.world(1).cluster().owner_heard_us().has_value());
  for (int i = 0; i < 60; ++i) {
    bench.tick();
    REQUIRE(bench.time_us - bench.world(1).cluster().owner_heard_us().value() < 1'500'000);
  }
  bench.servers[1].holds_from_owner = true;
  for (int i = 0; i < 60; ++i) bench.tick();
  CHECK(bench.time_us - bench.world(1).cluster().owner_heard_us().value() > 1'500'000);
}

TEST_CASE("a server that has handed the world over keeps no player and no server that only joins",
          "[world][servers][names]") {
  ClusterBench bench;
  bench.join(0, 1, 1);
  Hello ana = bench.hello(4, kFeaturesKnown);
  ana.name = "Ana";
  bench.world(0).connected(2, bench.now());
  bench.world(0).received(2, ana, bench.now());
  const Welcome welcome = bench.sent<Welcome>(0, 2).at(0);
  bench.world(0).received(2, bench.at(0).client_auth(4, ana, welcome), bench.now());
  CHECK_FALSE(bench.is_open(0, 2));  // the claim is not on disk
  Hello server = bench.hello(200);
  server.features = kFeatureServers;
  bench.world(0).connected(3, bench.now());
  bench.world(0).received(3, server, bench.now());
  bench.world(0).connected(4, bench.now());  // has sent nothing yet

  begin_handover(bench, 1);  // the claim is written
  for (const SessionId session : {2U, 3U}) {
    CAPTURE(session);
    REQUIRE(bench.end_of(0, session).has_value());
    CHECK(bench.end_of(0, session)->reason == GoodbyeReason::closing);
  }
  CHECK_FALSE(bench.end_of(0, 4).has_value());
  CHECK(bench.world(0).people().online().size() == 1);
  CHECK(bench.database.names.size() == 1);
  end_handover(bench, 1);
  bench.join(0, 5, 4, ana);
}

TEST_CASE("a player who waits at a former owner is let in by the next one, and not by the log",
          "[world][servers][names]") {
  ClusterBench bench;
  Hello ana = bench.hello(4, kFeaturesKnown);
  ana.name = "Ana";
  bench.world(0).cluster().hand_over({}, bench.now());
  bench.knock(0, 2, 4, ana);
  bench.world(0).names_durable(0, bench.now());
  bench.world(0).set_disk_is_full(false, bench.now());
  CHECK_FALSE(bench.is_open(0, 2));
  end_handover(bench, 1);
  CHECK(bench.is_open(0, 2));
  CHECK(bench.sent<Welcome>(0, 2).at(0).features == (kFeaturesKnown & ~kFeaturesOfOwner));
}

TEST_CASE("a session that was opened at the owner goes on at a server that follows",
          "[world][servers]") {
  ClusterBench bench;
  bench.join(0, 1, 1);
  bench.join(0, 2, 2);
  bench.join(0, 3, 3, bench.hello(3, kFeaturesKnown & ~kFeatureNames & ~kFeatureResume));
  for (const SessionId session : {1U, 2U, 3U}) bench.at(0).view(session, kSmall);
  bench.edit(0, 3, 1, block(9));
  bench.run();
  begin_handover(bench, 1);
  // Messages that only an owner can handle do no harm.
  bench.receive(0, 1, PreviewShare{{{block(1), {}, 1}}});
  CHECK(bench.world(0).people().commands().restore_preview_view(1).has_value());
  bench.world(0).people().commands().show_restore(1, {});
  bench.receive(0, 1, CommandRequest{7, "players"});
  REQUIRE(bench.sent<CommandOutput>(0, 1).size() == 1);
  CHECK_FALSE(bench.sent<CommandOutput>(0, 1)[0].is_ok);
  bench.receive(0, 1, ChatRequest{"nobody takes it"});
  bench.receive(0, 1, Move{Pose{{1, 2, 3}, 0, 0}});
  bench.receive(0, 1, LogMarksRequest{});
  for (int i = 0; i < 25; ++i) bench.tick();
  CHECK_FALSE(bench.end_of(0, 1).has_value());
  end_handover(bench, 1);
  CHECK_FALSE(bench.end_of(0, 1).has_value());
  // A client that cannot resume connects again.
  REQUIRE(bench.end_of(0, 3).has_value());
  CHECK(bench.end_of(0, 3)->reason == GoodbyeReason::closing);
  CHECK(bench.world(1).people().online().size() == 2);
  CHECK(bench.world(1).people().online()[0].at == WorldPos{1, 2, 3});
  CHECK(bench.sent<Welcome>(0, 1).at(0).features == (kFeaturesKnown & ~kFeatureNames));
  bench.receive(0, 1, PreviewShare{{{block(1), {}, 1}}});
  bench.pump();
  CHECK_FALSE(bench.end_of(0, 1).has_value());
}

TEST_CASE("a server that has handed the world over orders nothing, and takes reports of its log",
          "[world][servers][rights]") {
  WorldConfig c = config();
  c.snapshots.edits_max = 2;
  ClusterBench bench(1, c);
  bench.join(0, 1, 1);
  bench.at(0).view(1, kSmall);
  for (ClientSequence seq = 1; seq <= 3; ++seq) {
    bench.edit(0, 1, seq, block(static_cast<std::int32_t>(seq)));
    bench.run();
  }
  bench.tick();
  REQUIRE(bench.environment(0).saves.size() == 1);  // the writer has it
  begin_handover(bench, 1);
  bench.world(0).snapshots_saved(bench.now());
  bench.world(0).durable(3, bench.now());
  bench.tick();
  CHECK(bench.environment(0).saves.size() == 1);
  CHECK_FALSE(bench.world(0).order().accepts_edits());
  CHECK_FALSE(bench.world(0)
                  .changes()
                  .change_rights(SetDefaultRole{kVisitorRole}, {}, 0, bench.now())
                  .has_value());
  const auto offered = bench.world(0).changes().order_edits(
      {{{0, 5, 1}, Cause::rollback, 0, {block(1), {}, 1}, 1}}, 0, bench.now());
  CHECK(offered.state == ServerEditsResult::State::closed);
  CHECK(bench.world(0).order().is_flushed());
  end_handover(bench, 1);
  begin_handover(bench, 0);
  end_handover(bench, 0);
  CHECK(bench.world(0).order().accepts_edits());
  CHECK(bench.world(0)
            .changes()
            .change_rights(SetDefaultRole{kVisitorRole}, {}, 0, bench.now())
            .has_value());
}

TEST_CASE("an edit that one owner refused and the next one ordered counts as ordered",
          "[world][servers]") {
  WorldConfig c = config();
  c.edit_budget = {1, 1};
  ClusterBench bench(1, c);
  const AuthorId author = bench.join(1, 1, 2).author;
  bench.edit(1, 1, 1, block(1));
  bench.run();
  bench.servers[1].holds_from_owner = true;
  bench.edit(1, 1, 2, block(2));
  bench.run();
  CHECK(bench.world(0).order().resolved(author, 1) == 2);
  bench.world(0).cluster().hand_over({}, bench.now());
  bench.run();
  bench.world(0).cluster().handover_written(bench.now());
  bench.cut(1);  // the answer is lost
  bench.servers[1].holds_from_owner = false;
  end_handover(bench, 1);
  check_once(bench, author, 2);
  begin_handover(bench, 0);
  end_handover(bench, 0);
  bench.receive(1, 1, EditRequest{2, 0, {block(2), {}, 1}});  // again
  bench.run();
  REQUIRE(bench.sent<Reject>(1, 1).size() == 1);
  CHECK(bench.sent<Reject>(1, 1)[0].reason == RejectReason::already_resolved);
}

TEST_CASE("a world moves to the server whose players build, if the setting says so",
          "[world][servers]") {
  WorldConfig c = config();
  c.move_to_builders = GENERATE(false, true);
  ClusterBench bench(1, c);
  bench.join(0, 1, 1);
  bench.join(1, 1, 2);
  ClientSequence seq = 0;
  std::size_t answers = 0;
  for (int second = 0; second < 65; ++second) {
    for (int i = 0; i < 6; ++i) bench.edit(1, 1, ++seq, block(i));
    bench.tick(1'000'000);
    if (const auto successor = bench.world(0).cluster().take_better_owner()) {
      ++answers;
      CHECK(*successor == bench.servers[1].link);
      CHECK(bench.world(0).cluster().take_better_owner() == std::nullopt);
    }
  }
  CHECK(answers == (c.move_to_builders ? 1 : 0));
}

}  // namespace
}  // namespace runstone::test
