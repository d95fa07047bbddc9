// A server that follows the owner of its world: its connection with the owner, the log that it gets, and
// its chunks. The tests of its players are in relayed_players_test.cpp.
#include "server/world/cluster/following.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/server/world/cluster/cluster_bench.hpp"

namespace runstone::test {
namespace {

TEST_CASE("a follower that connects late reads what it lacks, and holds the rest back",
          "[world][servers]") {
  ClusterBench bench(0);
  bench.join(0, 1, 1);
  for (ClientSequence seq = 1; seq <= 3; ++seq) {
    bench.edit(0, 1, seq, block(static_cast<std::int32_t>(seq)));
    bench.run();
  }
  const std::size_t late = bench.add_follower();  // it has 3 records
  CHECK(bench.world(late).order().head() == 3);
  for (ClientSequence seq = 4; seq <= 8; ++seq) {
    bench.edit(0, 1, seq, block(static_cast<std::int32_t>(seq)));
    bench.run();
  }
  bench.read_records_max = 3;  // the one that it has, and two more
  bench.servers[late].holds_reads = true;
  bench.connect(late);
  bench.pump();
  REQUIRE(bench.environment(late).missed_log_reads == std::deque<Sequence>{3});
  CHECK_FALSE(bench.world(late).cluster().is_live());
  bench.edit(0, 1, 9, block(9));
  bench.run();
  CHECK(bench.servers[late].parts.size() == 1);
  CHECK(bench.world(late).order().head() == 3);  // record 9 waits
  bench.servers[late].holds_reads = false;
  for (int i = 0; i < 10 && !bench.world(late).cluster().is_live(); ++i) bench.tick();
  CHECK(bench.world(late).cluster().is_live());
  CHECK(bench.world(late).order().head() == 9);
  CHECK(bench.world(late).order().last_record() == Version{1, 9});
  CHECK(bench.world(late).order().resolved(1, 1) == 9);
  CHECK(bench.world(late).order().players().author_of(key_pair_of(seed_of(1)).public_key) == 1);
  bench.at(0).view(1, kSmall);
  bench.join(late, 1, 2);
  bench.at(late).view(1, kSmall);
  bench.check_same_chunks(0, late);
}

TEST_CASE(
    "servers of a world have one time of day, also one that comes late and one that takes over",
    "[world][servers][world_time]") {
  constexpr WorldTime kDawn{21'600'000, 30};
  ClusterBench bench(1);
  const auto time_at = [&](std::size_t server) {
    return bench.world(server).order().clock().at(bench.time_us);
  };
  REQUIRE(bench.world(0).changes().set_clock(kDawn, 0, bench.now()).has_value());
  const TimeUs set_us = bench.time_us;
  bench.run();
  CHECK(time_at(1) == kDawn);
  for (int i = 0; i < 10; ++i) bench.tick(1'000'000);
  const std::size_t late = bench.add_follower();  // it reads a record of ten seconds ago
  bench.connect(late);
  for (int i = 0; i < 5; ++i) bench.tick();
  REQUIRE(bench.world(late).cluster().is_live());
  CHECK(time_at(0) == later(kDawn, bench.time_us - set_us));
  CHECK(time_at(1) == time_at(0));
  CHECK(time_at(late) == time_at(0));
  CHECK(bench.world(late).order().clock().record() == 1);
  bench.lose_owner();
  REQUIRE(bench.take_over(late));
  bench.tick(2'000'000);
  CHECK(time_at(late) == later(kDawn, bench.time_us - set_us));
}

TEST_CASE("a player who waits for the owner at a late follower gets every commit once",
          "[world][servers]") {
  ClusterBench bench(1, config(), false);
  bench.join(0, 1, 1);
  bench.join(1, 1, 2);
  bench.at(1).view(1, kSmall);
  bench.edit(0, 1, 1, block(1));
  bench.run();
  bench.cut(1);
  bench.durable_max = 3;
  for (ClientSequence seq = 2; seq <= 5; ++seq) {
    bench.edit(0, 1, seq, block(static_cast<std::int32_t>(seq)));
    bench.run();
  }
  bench.connect(1);
  bench.tick();
  bench.edit(0, 1, 6, block(6));
  for (int i = 0; i < 5; ++i) bench.tick();
  // Records 4 and 5 are not durable. So the reader does not find them, and 6 waits.
  CHECK_FALSE(bench.world(1).cluster().is_live());
  CHECK(bench.world(1).order().head() == 3);
  CHECK(bench.sequences(1, 1) == std::vector<Sequence>{1, 2, 3});
  bench.durable_max = 4;
  for (int i = 0; i < 5; ++i) bench.tick();
  CHECK_FALSE(bench.world(1).cluster().is_live());
  CHECK(bench.sequences(1, 1) == std::vector<Sequence>{1, 2, 3, 4});
  bench.durable_max = 6;
  for (int i = 0; i < 5; ++i) bench.tick();
  CHECK(bench.world(1).cluster().is_live());
  CHECK(bench.sequences(1, 1) == std::vector<Sequence>{1, 2, 3, 4, 5, 6});
  for (const OrderedEdit& edit : bench.edits(1, 1))
    CHECK(edit.previous == std::vector<Sequence>{edit.seq - 1});
  CHECK(bench.world(1).order().durable() == 6);
}

TEST_CASE(
    "sessions stay when the connection with the owner ends, and their edits are offered again",
    "[world][servers]") {
  ClusterBench bench;
  bench.join(0, 1, 1);
  const AuthorId author = bench.join(1, 1, 2).author;
  bench.edit(1, 1, 1, block(1));
  bench.run();
  // The owner orders the second edit, but its records do not arrive.
  bench.servers[1].holds_from_owner = true;
  bench.edit(1, 1, 2, block(2));
  bench.run();
  CHECK(bench.world(0).order().head() == 2);
  CHECK(bench.world(1).order().head() == 1);
  // The third one is lost on the way.
  bench.servers[1].holds_to_owner = true;
  bench.edit(1, 1, 3, block(3));
  bench.cut(1);
  bench.servers[1].holds_from_owner = bench.servers[1].holds_to_owner = false;
  CHECK_FALSE(bench.world(1).cluster().is_live());
  CHECK(bench.is_open(1, 1));
  CHECK(bench.world(0).people().online().size() == 1);  // the owner has lost the player
  bench.edit(1, 1, 4, block(4));
  bench.receive(1, 1, Move{Pose{{7, 8, 9}, 0, 0}});
  bench.tick();
  CHECK(bench.world(1).order().head() == 1);
  bench.edit(0, 1, 1, block(5));
  bench.tick();

  bench.connect(1);
  for (int i = 0; i < 3; ++i) bench.tick();
  CHECK(bench.world(1).cluster().is_live());
  CHECK(bench.is_open(1, 1));
  CHECK_FALSE(bench.end_of(1, 1).has_value());
  CHECK(bench.sent<SessionAccepted>(1, 1).size() == 1);  // the session just goes on
  REQUIRE(bench.world(0).people().online().size() == 2);
  CHECK(bench.world(0).people().online()[1].author == author);
  CHECK(bench.world(0).people().online()[1].at == WorldPos{7, 8, 9});
  std::vector<ClientSequence> mine;
  for (const OrderedEdit& edit : bench.edits(1, 1)) {
    if (edit.op.author == author) mine.push_back(edit.op.seq);
  }
  CHECK(mine == std::vector<ClientSequence>{1, 2, 3, 4});
  CHECK(bench.world(0).order().head() == 5);
  CHECK(bench.database.records.size() == 5);
  CHECK(bench.sent<Reject>(1, 1).empty());
}

TEST_CASE("an edit that the owner orders while a follower connects again is applied once",
          "[world][servers]") {
  ClusterBench bench;
  bench.join(1, 1, 2);
  bench.edit(1, 1, 1, block(1));
  bench.pump();  // the owner has it, and has not ordered it
  bench.cut(1);
  bench.servers[1].holds_from_owner = true;
  bench.connect(1);
  bench.servers[1].holds_from_owner = false;
  bench.pump();
  bench.run();
  bench.tick();
  CHECK(bench.world(0).order().head() == 1);
  CHECK(bench.sequences(1, 1) == std::vector<Sequence>{1});
  bench.edit(1, 1, 2, block(2));
  bench.run();
  CHECK(bench.sequences(1, 1) == std::vector<Sequence>{1, 2});
}

TEST_CASE("a follower leaves an owner that is silent, takes nothing, or is another world's",
          "[world][servers]") {
  ClusterBench bench;
  bench.join(1, 1, 2);
  SECTION("silent") {
    bench.servers[1].holds_from_owner = true;
    for (int i = 0; i < 49; ++i) {
      bench.at(1).time_us = (bench.time_us += 100'000);
      bench.at(1).tick(0);
    }
    CHECK(bench.environment(1).owners_left.empty());
    bench.time_us += 100'000;
    bench.at(1).time_us = bench.time_us;
    bench.at(1).tick(0);
  }
  SECTION("full") {
    bench.environment(1).is_owner_full = true;
    bench.edit(1, 1, 1, block(1));
  }
  SECTION("a gap") {
    LogPart part;
    part.records.push_back({{{1, 2}, {1, 1, 1}, 5, Cause::player, {block(1), {}, 1}}, 0});
    bench.world(1).cluster().owner_received(part, bench.now());
  }
  CHECK(bench.environment(1).owners_left.size() == 1);
  CHECK_FALSE(bench.world(1).cluster().is_live());
  CHECK(bench.world(1).order().head() == 0);
  CHECK(bench.is_open(1, 1));
}

TEST_CASE("a follower believes no server that has not the world's key", "[world][servers]") {
  ClusterBench bench(0);
  const std::size_t follower = bench.add_follower();
  WorldConfig other = config();
  other.server_keys = key_pair_of(seed_of(99));
  WorldBench impostor(other);
  const auto welcome_from = [&](WorldBench& from, SessionId session) {
    bench.world(follower).cluster().owner_connected(std::nullopt, bench.now());
    const EncodedMessage hello = bench.environment(follower).to_owner.back();
    bench.environment(follower).to_owner.clear();
    auto message = decode_message(Sender::client, hello.kind, *hello.bytes, 0);
    REQUIRE(message.has_value());
    from.server.connected(session, from.now());
    from.server.received(session, *std::move(message), from.now());
    return from.environment.messages<Welcome>(session, 0).at(0);
  };
  const auto refused = [&](const Welcome& welcome) {
    const std::size_t before = bench.environment(follower).owners_left.size();
    bench.world(follower).cluster().owner_received(welcome, bench.now());
    CHECK(bench.environment(follower).to_owner.empty());
    return bench.environment(follower).owners_left.size() == before + 1;
  };
  CHECK(refused(welcome_from(impostor, 1)));
  Welcome forged = welcome_from(bench.at(0), 1);
  ++forged.challenge[0];
  CHECK(refused(forged));
  Welcome no_server = welcome_from(bench.at(0), 2);
  bench.world(follower).cluster().owner_received(no_server, bench.now());
  CHECK(bench.environment(follower).to_owner.size() == 1);  // client auth
}

TEST_CASE("a chunk that is newer than what has arrived is loaded again, and is not quarantined",
          "[world][servers]") {
  ClusterBench bench;
  bench.join(0, 1, 1);
  bench.at(0).view(1, kSmall);
  bench.join(1, 1, 2);
  bench.servers[1].holds_from_owner = true;
  bench.edit(0, 1, 1, kAtOrigin);
  bench.run();
  const ChunkKey key{0, {0, 0, 0}};
  const ChunkPtr saved = bench.world(0).order().chunks().find(key);
  REQUIRE(saved != nullptr);
  REQUIRE(saved->version == Version{1, 1});
  bench.at(1).send_view(1, View{1, {0, 0, 0}, 0, 0});
  bench.at(1).tick(0);
  auto& loads = bench.environment(1).loads;
  // The owner does not reach the follower for minutes. The follower does not give the chunk up.
  for (int i = 0; i < 200; ++i) {
    for (; !loads.empty(); loads.pop_front()) {
      REQUIRE(loads.front() == key);
      bench.world(1).chunk_loaded(key, *saved, bench.now());
    }
    CHECK(bench.world(1).order().chunks().find(key) == nullptr);
    bench.at(1).time_us = (bench.time_us += 1'000'000);
    bench.receive(1, 1, Ping{});
    bench.at(1).tick(0);
    if (bench.servers[1].owner && !bench.environment(1).owners_left.empty()) bench.cut(1);
  }
  CHECK(bench.world(1).counters().chunks_failed == 0);
  CHECK(bench.sent<ChunkUnavailable>(1, 1).empty());
  bench.servers[1].holds_from_owner = false;
  bench.connect(1);
  for (int i = 0; i < 4; ++i) {
    bench.tick(1'000'000);
    for (; !loads.empty(); loads.pop_front()) bench.world(1).chunk_loaded(key, *saved, bench.now());
  }
  REQUIRE(bench.world(1).order().chunks().find(key) != nullptr);
  CHECK(bench.world(1).order().chunks().find(key)->version == Version{1, 1});
  CHECK(bench.world(1).order().chunks().find(key)->digest == saved->digest);
}

TEST_CASE("the owner's checkpoint frees the stacks of a follower and lets its chunks go",
          "[world][servers]") {
  WorldConfig c = config();
  c.memory.idle_bytes_max = 0;
  c.snapshots.edits_max = 1;
  ClusterBench bench(1, c);
  bench.join(0, 1, 1);
  bench.join(1, 1, 2);
  bench.at(1).view(1, View{1, {0, 0, 0}, 0, 0});
  bench.edit(0, 1, 1, kAtOrigin);             // in memory at the follower
  bench.edit(0, 1, 2, SetVoxel{{40, 1, 1}});  // not in memory
  bench.run();
  CHECK(bench.world(1).order().dirty_chunks() == 2);
  CHECK(bench.world(1).order().memory().stacked > 0);
  bench.world(1).disconnected(1);
  for (int i = 0; i < 3; ++i) bench.tick();
  CHECK(bench.world(1).order().chunks().resident_count() == 1);  // only the log has its edit
  bench.world(1).cluster().checkpoint_moved(1);
  CHECK(bench.world(1).order().dirty_chunks() == 1);
  CHECK(bench.world(1).order().memory().stacked > 0);
  for (int i = 0; i < 3; ++i) bench.tick();
  CHECK(bench.world(1).order().chunks().resident_count() == 0);
  bench.world(1).cluster().checkpoint_moved(2);
  CHECK(bench.world(1).order().dirty_chunks() == 0);
  CHECK(bench.world(1).order().memory().stacked == 0);
  CHECK(bench.world(1).order().chunks().version({0, {2, 0, 0}}) == Version{1, 2});
  CHECK(bench.environment(1).saves.empty());  // the owner writes snapshots
}

TEST_CASE("a load that began before the owner's checkpoint may bring an older snapshot",
          "[world][servers]") {
  ClusterBench bench;
  bench.join(0, 1, 1);
  bench.join(1, 1, 2);
  const ChunkKey key{0, {0, 0, 0}};
  bench.at(1).send_view(1, View{1, key.at, 0, 0});
  bench.at(1).tick(0);
  REQUIRE(bench.environment(1).loads == std::deque<ChunkKey>{key});
  bench.edit(0, 1, 1, kAtOrigin);
  bench.run();
  bench.world(1).cluster().checkpoint_moved(1);
  bench.at(1).answer_loads();
  REQUIRE(bench.world(1).order().chunks().find(key) != nullptr);
  CHECK(bench.world(1).order().chunks().find(key)->version == Version{1, 1});
  CHECK(bench.world(1).counters().chunks_failed == 0);
  bench.world(1).cluster().checkpoint_moved(1);
  CHECK(bench.world(1).order().dirty_chunks() == 0);
}

TEST_CASE("a follower leaves an owner that has lost the world to another server",
          "[world][servers]") {
  ClusterBench bench(1, config(), false);
  bench.join(0, 1, 1);
  bench.join(1, 1, 2);
  bench.edit(0, 1, 1, SetVoxel{{1, 1, 1}});
  bench.run();
  bench.durable_max = 1;
  bench.edit(0, 1, 2, SetVoxel{{2, 1, 1}});
  bench.run();
  const std::size_t late = bench.add_follower();
  bench.servers[late].holds_reads = true;
  bench.connect(late);
  bench.pump();
  CHECK_FALSE(
      bench.world(late).cluster().is_live());  // it waits for the record that is not durable
  bench.durable_max = 100;
  REQUIRE(bench.take_over(1));
  bench.edit(1, 1, 1, SetVoxel{{3, 1, 1}});
  bench.run();
  REQUIRE(bench.database.records.back().version == Version{2, 3});
  const auto order_at_old_owner = [&](ClientSequence seq) {
    bench.edit(0, 1, seq, SetVoxel{{4, 1, 1}});
    bench.world(0).commit(bench.now());
    bench.pump();
  };
  auto& left = bench.environment(late).owners_left;
  SECTION("it reads an edit of the next owner from the database") {
    order_at_old_owner(3);
    bench.servers[late].holds_reads = false;
    bench.tick();
    order_at_old_owner(4);
  }
  SECTION("it gets an edit of the old owner after one of the next") {
    bench.servers[late].holds_from_owner = true;
    order_at_old_owner(3);
    order_at_old_owner(4);
    bench.servers[late].holds_reads = false;
    bench.tick();
    bench.servers[late].holds_from_owner = false;
    bench.pump();
  }
  REQUIRE_FALSE(left.empty());
  CHECK(left.front() == "another server has taken the world over");
  CHECK_FALSE(bench.world(late).cluster().has_forked());
  bench.cut(late);
  bench.connect(late);
  for (int i = 0; i < 4; ++i) bench.tick();
  CHECK(bench.world(late).cluster().is_live());
  CHECK(bench.world(late).order().last_record() == Version{2, 3});
}

TEST_CASE("a follower leaves an owner whose records go back to an earlier epoch",
          "[world][servers]") {
  ClusterBench bench;
  bench.join(0, 1, 1);
  REQUIRE(bench.take_over(1));
  const std::size_t follower = bench.add_follower();
  bench.connect(follower);
  bench.join(1, 1, 2);
  bench.edit(1, 1, 1, SetVoxel{{1, 1, 1}});
  bench.run();
  REQUIRE(bench.world(follower).order().last_record() == Version{2, 1});
  LogPart part = bench.servers[follower].parts.back();
  REQUIRE(part.records.size() == 1);
  part.records[0].record.version = {1, 2};
  bench.world(follower).cluster().owner_received(part, bench.now());
  CHECK(bench.world(follower).order().last_record() == Version{2, 1});
  REQUIRE(bench.environment(follower).owners_left.size() == 1);
  CHECK(bench.environment(follower).owners_left[0] == "another server has taken the world over");
}

TEST_CASE("a follower does not give up a chunk while the database is away", "[world][servers]") {
  ClusterBench bench;
  bench.join(1, 1, 2);
  const ChunkKey key{0, {0, 0, 0}};
  bench.at(1).send_view(1, View{1, key.at, 0, 0});
  bench.at(1).tick(0);
  auto& loads = bench.environment(1).loads;
  std::size_t failures = 0;
  for (int i = 0; i < 300; ++i) {
    for (; !loads.empty(); loads.pop_front(), ++failures)
      bench.world(1).chunk_failed(key, LoadFailure::not_read, "no connection", bench.now());
    bench.receive(1, 1, Ping{});
    bench.tick(1'000'000);
  }
  CHECK(failures > 10);
  CHECK(bench.world(1).counters().chunks_failed == 0);
  CHECK(bench.sent<ChunkUnavailable>(1, 1).empty());
}

}  // namespace
}  // namespace runstone::test
