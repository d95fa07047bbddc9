// A server that follows becomes the owner of the world, because the owner is gone.
#include <catch2/catch.hpp>
#include <set>

#include "common/names/folded_name.hpp"
#include "tests/unit/server/world/cluster/cluster_bench.hpp"

namespace runstone::test {
namespace {

SetVoxel place(std::int32_t x) { return {{x, 1, 1}}; }

constexpr std::uint64_t kNoResume = kFeaturesKnown & ~kFeatureNames & ~kFeatureResume;

/// Returns the kinds of the messages of a session in which epochs matter, with their epochs.
std::vector<std::pair<MessageKind, Epoch>> epochs_sent(ClusterBench& bench, std::size_t server,
                                                       SessionId session) {
  std::vector<std::pair<MessageKind, Epoch>> all;
  for (const auto& sent : bench.environment(server).sent) {
    if (sent.session != session) continue;
    if (sent.message.kind != kKindOf<Commit> && sent.message.kind != kKindOf<Durable>) continue;
    const auto message =
        decode_message(Sender::server, sent.message.kind, *sent.message.bytes, kEdge);
    REQUIRE(message.has_value());
    if (const auto* commit = std::get_if<Commit>(&*message)) {
      all.emplace_back(sent.message.kind, commit->epoch);
    } else {
      all.emplace_back(sent.message.kind, std::get<Durable>(*message).epoch);
    }
  }
  return all;
}

TEST_CASE("a follower takes the world over with the records that the owner did not write",
          "[world][servers]") {
  ClusterBench bench(2);
  bench.join(0, 1, 1);
  const AuthorId author = bench.join(1, 1, 2).author;
  const AuthorId other = bench.join(2, 1, 3).author;
  bench.at(1).view(1, kSmall);
  bench.at(2).view(1, kSmall);
  bench.join(1, 2, 4, bench.hello(4, kNoResume));
  bench.join(2, 2, 5, bench.hello(5, kNoResume));
  bench.edit(0, 1, 1, place(1));
  bench.run();
  bench.durable_max = 1;
  bench.edit(1, 1, 1, place(2));
  bench.run();
  bench.edit(2, 1, 1, FillBox{{{0, 0, 0}, {20, 3, 3}}});
  bench.run();
  CHECK(bench.world(1).order().head() == 3);
  CHECK(bench.database.last() == 1);
  CHECK(bench.database.players.size() == 1);
  bench.lose_owner();
  bench.edit(1, 1, 2, place(3));
  bench.edit(2, 1, 2, place(4));
  bench.durable_max = 100;

  REQUIRE(bench.take_over(1));
  CHECK_FALSE(bench.world(1).cluster().is_following());
  CHECK(bench.world(1).order().epoch() == 2);
  CHECK(bench.database.last() == 3);  // nothing that arrived here is lost
  CHECK(bench.database.records[1].version == Version{1, 2});
  CHECK(bench.database.records[2].op == OperationId{other, 1, 1});
  CHECK(bench.database.players.size() == 3);
  CHECK(bench.world(1).order().durable() == 3);
  // The session whose client cannot follow to another epoch is closed, and the other one goes on.
  REQUIRE(bench.end_of(1, 2).has_value());
  CHECK(bench.end_of(1, 2)->reason == GoodbyeReason::closing);
  CHECK_FALSE(bench.end_of(1, 1).has_value());
  bench.run();
  CHECK(bench.sent<SessionAccepted>(1, 1).size() == 1);
  // The edit that waited is ordered in the new epoch.
  REQUIRE(bench.database.records.size() == 4);
  CHECK(bench.database.records[3].version == Version{2, 4});
  CHECK(bench.database.records[3].op == OperationId{author, 1, 2});
  CHECK(bench.sequences(1, 1) == std::vector<Sequence>{1, 2, 3, 4});

  // The other follower goes on with the new owner.
  CHECK_FALSE(bench.end_of(2, 2).has_value());
  bench.connect(2);
  for (int i = 0; i < 3; ++i) bench.tick();
  CHECK(bench.world(2).cluster().is_live());
  CHECK_FALSE(bench.world(2).cluster().has_forked());
  CHECK(bench.world(2).order().epoch() == 2);
  REQUIRE(bench.end_of(2, 2).has_value());
  CHECK_FALSE(bench.end_of(2, 1).has_value());
  CHECK(bench.sent<SessionAccepted>(2, 1).size() == 1);
  CHECK(bench.sequences(2, 1) == std::vector<Sequence>{1, 2, 3, 4, 5});
  CHECK(bench.sequences(1, 1) == std::vector<Sequence>{1, 2, 3, 4, 5});
  CHECK(bench.edits(1, 1)[4].op == OperationId{other, 1, 2});
  CHECK(bench.world(1).order().players().author_of(bench.hello(3).key) == other);
  bench.check_same_chunks(1, 2);

  // A Durable of the new epoch precedes the first commit of it.
  for (const std::size_t server : {1U, 2U}) {
    CAPTURE(server);
    const auto sent = epochs_sent(bench, server, 1);
    CHECK(std::ranges::is_sorted(sent, {}, [](const auto& entry) { return entry.second; }));
    const auto first = std::ranges::find(sent, Epoch{2}, [](const auto& s) { return s.second; });
    REQUIRE(first != sent.end());
    CHECK(first->first == kKindOf<Durable>);
    CHECK(sent.back().second == 2);
  }
  // No session without the feature got anything of the new epoch.
  for (const std::size_t server : {1U, 2U}) {
    for (const auto& [kind, epoch] : epochs_sent(bench, server, 2)) CHECK(epoch == 1);
  }

  // Both go on.
  bench.edit(1, 1, 3, place(5));
  bench.edit(2, 1, 3, place(6));
  bench.run();
  CHECK(bench.sequences(1, 1).size() == 7);
  CHECK(bench.sequences(2, 1).size() == 7);
  bench.check_same_chunks(1, 2);
  // A new player gets a number that none of them has.
  CHECK(bench.join(2, 9, 6).author == 5);
  // The owner offers everything again.
  CHECK((bench.join(1, 9, 7).author != 0));
  CHECK(bench.sent<Welcome>(1, 9).at(0).features == (kFeaturesKnown & ~kFeatureNames));
  CHECK(bench.sent<Welcome>(1, 9).at(0).epoch == 2);
}

TEST_CASE("an edit that the lost owner has ordered is not applied again", "[world][servers]") {
  ClusterBench bench;
  bench.join(1, 1, 2);
  bench.servers[1].holds_from_owner = true;
  bench.edit(1, 1, 1, place(1));
  bench.run();  // on disk, and no word of it arrived
  CHECK(bench.database.last() == 1);
  CHECK(bench.world(1).order().head() == 0);
  bench.lose_owner();
  REQUIRE(bench.take_over(1));
  bench.run();
  CHECK(bench.world(1).order().head() == 1);
  CHECK(bench.sequences(1, 1) == std::vector<Sequence>{1});
  CHECK(bench.sent<Reject>(1, 1).empty());
}

TEST_CASE("edits that a client sent before it knew of a takeover are ignored, and offered again",
          "[world][servers]") {
  ClusterBench bench;
  const AuthorId author = bench.join(1, 1, 2).author;
  bench.join(1, 2, 3);
  bench.edit(1, 1, 1, place(1));
  bench.run();
  bench.lose_owner();
  bench.edit(1, 1, 2, place(2));  // lost: there is no owner
  bench.answers_resumes = false;
  REQUIRE(bench.take_over(1));
  REQUIRE(bench.sent<Resume>(1, 1).size() == 1);
  CHECK(bench.sent<Resume>(1, 1)[0].resolved == 1);
  CHECK(bench.sent<Resume>(1, 2)[0].resolved == 0);
  // It was sent before the client knew. If it were ordered, edit 2 would never be.
  bench.edit(1, 1, 3, place(3));
  bench.run();
  CHECK(bench.world(1).order().head() == 1);
  bench.answers_resumes = true;
  bench.run();
  CHECK(bench.world(1).order().head() == 3);
  CHECK(bench.world(1).order().resolved(author, 1) == 3);
  CHECK(bench.unanswered(1, 1).empty());
  // One answer for each.
  bench.receive(1, 1, Resumed{});
  REQUIRE(bench.end_of(1, 1).has_value());
  CHECK(bench.end_of(1, 1)->reason == GoodbyeReason::unexpected_message);
  CHECK_FALSE(bench.end_of(1, 2).has_value());
}

TEST_CASE("players see each other, write and come in after a takeover", "[world][servers]") {
  ClusterBench bench(2);
  bench.join(1, 1, 2);
  const AuthorId other = bench.join(2, 1, 3).author;
  bench.edit(2, 1, 1, place(1));  // all servers know the player now
  bench.tick();
  bench.lose_owner();
  bench.receive(2, 1, Move{Pose{{1, 2, 3}, 0, 0}});
  bench.knock(1, 5, 4, bench.hello(4));
  bench.knock(1, 6, 5, bench.hello(5, kNoResume));
  CHECK_FALSE(bench.is_open(1, 5));
  const std::size_t lists = bench.sent<PlayerList>(1, 1).size();
  REQUIRE(bench.take_over(1));
  bench.run();
  CHECK(bench.is_open(1, 5));
  // Welcome named the earlier epoch. So the session learns of the new one, or ends.
  const auto epochs = epochs_sent(bench, 1, 5);
  REQUIRE_FALSE(epochs.empty());
  CHECK(epochs[0] == std::pair{kKindOf<Durable>, Epoch{2}});
  CHECK_FALSE(bench.is_open(1, 6));
  REQUIRE(bench.end_of(1, 6).has_value());
  CHECK(bench.end_of(1, 6)->reason == GoodbyeReason::closing);
  bench.tick();
  REQUIRE(bench.sent<PlayerList>(1, 1).size() > lists);
  const PlayerList list = bench.sent<PlayerList>(1, 1)[lists];
  CHECK_FALSE(list.is_change);  // the clients learn who is there now
  bench.connect(2);
  bench.tick(1'000'000);
  CHECK(bench.world(1).people().online().size() == 3);
  const auto poses = bench.sent<PlayerPoses>(1, 1);
  REQUIRE_FALSE(poses.empty());
  CHECK(std::ranges::count(poses.back().players, PlayerPose{other, {{1, 2, 3}, 0, 0}}) == 1);
  bench.receive(2, 1, ChatRequest{"still here"});
  bench.tick();
  REQUIRE_FALSE(bench.sent<ChatLines>(1, 1).empty());
  CHECK(bench.sent<ChatLines>(1, 1).back().lines.back().text == "still here");
  CHECK(bench.sent<ChatLines>(1, 1).back().lines.back().author == other);
}

TEST_CASE("followers learn of the new epoch before it has records", "[world][servers]") {
  ClusterBench bench(2);
  bench.join(2, 1, 3);
  bench.database.author_max = 40;  // somebody's row is lost
  bench.lose_owner();
  REQUIRE(bench.take_over(1));
  bench.connect(2);
  bench.pump();
  CHECK(bench.world(2).order().epoch() == 2);
  CHECK(epochs_sent(bench, 2, 1).back() == std::pair{kKindOf<Durable>, Epoch{2}});
  CHECK(bench.join(2, 2, 4).author == 41);
}

TEST_CASE("claims of names outlive the owner that made them", "[world][servers][names]") {
  ClusterBench bench;
  Hello ana = bench.hello(2, kFeaturesKnown);
  ana.name = "Ana";
  bench.join(1, 1, 2, ana);
  bench.database.names.clear();  // as if the owner had not written it
  bench.lose_owner();
  REQUIRE(bench.take_over(1));
  CHECK(bench.database.names.contains(folded_name("Ana")));
  REQUIRE(bench.world(1).order().names().all().size() == 1);
  Hello other = bench.hello(3, kFeaturesKnown);
  other.name = "ana";
  bench.knock(1, 5, 3, other);
  REQUIRE(bench.end_of(1, 5).has_value());
  CHECK(bench.end_of(1, 5)->reason == GoodbyeReason::name_refused);
}

TEST_CASE("a player whose number another one got while the owner was away is closed",
          "[world][servers]") {
  ClusterBench bench(2);
  const AuthorId author = bench.join(2, 1, 3).author;  // it has no row: nothing tells server 1
  bench.lose_owner();
  REQUIRE(bench.take_over(1));
  CHECK(bench.join(1, 1, 2).author == author);
  bench.connect(2);
  bench.tick();
  REQUIRE(bench.end_of(2, 1).has_value());
  CHECK(bench.end_of(2, 1)->reason == GoodbyeReason::closing);
  CHECK(bench.join(2, 2, 3).author != author);
}

TEST_CASE("a follower with records that the new owner lacks has forked and applies nothing",
          "[world][servers]") {
  ClusterBench bench(2);
  bench.join(0, 1, 1);
  bench.join(2, 1, 3);
  bench.at(2).view(1, kSmall);
  bench.edit(0, 1, 1, place(1));
  bench.run();
  bench.durable_max = 1;
  bench.servers[1].holds_from_owner = true;
  bench.edit(0, 1, 2, place(2));
  bench.run();
  bench.edit(0, 1, 3, place(3));
  bench.run();
  CHECK(bench.world(1).order().head() == 1);
  CHECK(bench.world(2).order().head() == 3);
  bench.lose_owner();
  bench.servers[1].holds_from_owner = false;
  bench.durable_max = 100;
  REQUIRE(bench.take_over(1));
  CHECK(bench.world(1).order().head() == 1);
  bench.join(1, 1, 2);
  std::size_t edits = 0;
  SECTION("the new owner has fewer records") {}
  SECTION("the new owner has as many") { edits = 2; }
  SECTION("the new owner has more") { edits = 5; }
  for (ClientSequence seq = 1; seq <= edits; ++seq) {
    bench.edit(1, 1, seq, place(static_cast<std::int32_t>(seq) + 8));
    bench.run();
  }
  bench.connect(2);
  for (int i = 0; i < 5; ++i) bench.tick();
  CHECK(bench.world(2).cluster().has_forked());
  CHECK_FALSE(bench.world(2).cluster().is_live());
  CHECK(bench.world(2).order().head() == 3);
  CHECK(bench.world(2).order().last_record() == Version{1, 3});
  CHECK(bench.sequences(2, 1) == std::vector<Sequence>{1, 2, 3});
  CHECK(bench.world(1).cluster().follower_count() == 0);
}

TEST_CASE("a server that forked does not take the world over", "[world][servers]") {
  ClusterBench bench;
  bench.join(0, 1, 1);
  bench.edit(0, 1, 1, place(1));
  bench.run();
  bench.durable_max = 1;
  bench.edit(0, 1, 2, place(2));
  bench.run();
  bench.lose_owner();
  const auto parts = bench.world(1).cluster().stop_following();
  REQUIRE(parts.size() == 1);
  CHECK(parts[0].records.size() == 1);
  CHECK(parts[0].records[0].record.version == Version{1, 2});
  Takeover start;
  start.epoch = 3;
  start.read = bench.database.read(1, 100);
  SECTION("its records are missing") {}
  SECTION("there are others") {
    EditRecord other = bench.database.records.back();
    other.version = {2, 2};
    ++other.op.seq;
    start.read.records.push_back(other);
    start.read.last = 2;
  }
  CHECK_FALSE(bench.world(1).cluster().take_over(start, bench.now()));
  CHECK(bench.world(1).cluster().has_forked());
  CHECK(bench.world(1).cluster().is_following());
  CHECK(bench.world(1).order().head() == 2);
}

TEST_CASE("a server that takes the world over listens to no owner any more", "[world][servers]") {
  ClusterBench bench;
  bench.lose_owner();
  CHECK(bench.world(1).cluster().stop_following().empty());
  bench.world(1).cluster().owner_connected(std::nullopt, bench.now());
  CHECK(bench.environment(1).to_owner.empty());
  CHECK(bench.environment(1).owners_left.size() == 1);
}

TEST_CASE("a server that takes over orders changes and edits of its own",
          "[world][servers][rights]") {
  ClusterBench bench;
  bench.join(1, 1, 2);
  bench.at(1).view(1, kSmall);
  bench.edit(1, 1, 1, place(1));
  bench.run();
  bench.lose_owner();
  bench.database.checkpoint = 1;  // the owner has moved it, and the follower has not heard of it
  REQUIRE(bench.take_over(1));
  CHECK(bench.world(1).order().checkpoint() == 1);
  REQUIRE(bench.world(1)
              .changes()
              .change_rights(SetDefaultRole{kVisitorRole}, {}, 0, bench.now())
              .has_value());
  bench.run();
  CHECK(bench.database.last() == 2);
  bench.edit(1, 1, 2, place(2));
  bench.run();
  REQUIRE(bench.sent<Reject>(1, 1).size() == 1);
  CHECK(bench.sent<Reject>(1, 1)[0].reason == RejectReason::not_permitted);
  // It writes snapshots now, and the chunks that it followed are among them.
  CHECK(bench.world(1).order().dirty_chunks() == 1);
  bench.world(1).begin_stop(bench.now());
  REQUIRE_FALSE(bench.environment(1).saves.empty());
  CHECK(bench.environment(1).saves[0].chunks.size() == 1);
}

TEST_CASE("the next owner goes on from the time of the one before, although its clock is ahead",
          "[world][servers][clock]") {
  constexpr TimeUs kSecond = 1'000'000;
  ClusterBench bench;
  bench.at(1).wall_error_us = 2 * 365 * 86'400 * kSecond;
  bench.join(1, 1, 2);
  bench.edit(1, 1, 1, place(1));
  bench.tick();
  bench.tick();
  bench.lose_owner();
  REQUIRE(bench.take_over(1));
  bench.edit(1, 1, 2, place(2));
  bench.tick();
  REQUIRE(bench.database.last() == 2);
  const TimeUs apart_us = bench.database.records.back().time_us - bench.now().utc_us;
  CHECK((apart_us <= kSecond && apart_us >= -kSecond));
  const auto& lines = bench.environment(1).lines;
  CHECK(std::ranges::count_if(lines, [](const std::string& line) {
          return line.starts_with("the wall clock has jumped: ");
        }) == 1);
}

TEST_CASE("the next owner does not keep the full disk of the one before", "[world][servers]") {
  ClusterBench bench;
  bench.join(1, 1, 2);
  bench.world(0).set_disk_is_full(true, bench.now());
  bench.tick(1'000'000);
  REQUIRE(bench.sent<Durable>(1, 1).back().is_read_only);
  bench.lose_owner();
  REQUIRE(bench.take_over(1));
  CHECK_FALSE(bench.sent<Durable>(1, 1).back().is_read_only);
  bench.edit(1, 1, 1, place(1));
  bench.run();
  CHECK(bench.sent<Reject>(1, 1).empty());
  CHECK(bench.database.last() == 1);
}

TEST_CASE("shapes go on over a takeover, also those that the owner did not write",
          "[world][servers][shapes]") {
  const Shape slab{ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};
  const Shape plant{ShapeForm::crossed, {{{1, 0, 1}, {15, 12, 15}}}};
  ClusterBench bench(2);
  for (std::size_t server = 0; server < 3; ++server)
    bench.join(server, 1, static_cast<std::uint8_t>(server + 1));
  const auto give = [&](std::size_t server, Material material, const Shape& shape) {
    REQUIRE(
        bench.world(server).changes().give_shapes({{material, shape}}, bench.now()).has_value());
    bench.run();
  };
  give(0, 1, slab);
  bench.durable_max = 1;
  give(0, 3, plant);
  CHECK(bench.database.last() == 1);
  for (const std::size_t server : {1U, 2U}) {
    CHECK(bench.world(server).order().materials() == bench.world(0).order().materials());
    CHECK(bench.world(server).order().tile_rules() == bench.world(0).order().tile_rules());
    CHECK(bench.sent<ShapesGiven>(server, 1).size() == 2);
  }
  const MaterialTable before = bench.world(0).order().materials();
  bench.lose_owner();
  bench.durable_max = 100;
  REQUIRE(bench.take_over(1));
  CHECK(bench.database.last() == 2);
  REQUIRE(given_shapes_of(bench.database.records[1].edit) != nullptr);
  CHECK(*given_shapes_of(bench.database.records[1].edit) == GivenShapes{{{3, plant}}});
  CHECK(bench.world(1).order().materials() == before);
  bench.connect(2);
  for (int i = 0; i < 3; ++i) bench.tick();
  CHECK_FALSE(bench.world(2).cluster().has_forked());

  // The new owner gives each material a shape once, as the owner before would.
  CHECK_FALSE(bench.world(1).changes().give_shapes({{3, slab}}, bench.now()).has_value());
  give(1, 2, slab);
  CHECK(bench.world(2).order().materials() == bench.world(1).order().materials());
  CHECK(bench.world(2).order().tile_rules() == bench.world(1).order().tile_rules());
  for (const std::size_t server : {1U, 2U}) {
    CHECK(bench.is_open(server, 1));
    CHECK(bench.sent<ShapesGiven>(server, 1).size() == 3);
    bench.join(server, 9, static_cast<std::uint8_t>(server + 5));
    CHECK(bench.sent<Welcome>(server, 9).at(0).materials == bench.world(1).order().materials());
  }
}

}  // namespace
}  // namespace runstone::test
