// Players at a server that follows the owner of its world: what they see of the owner's world, and what
// becomes of their edits, lines, commands and sessions.
#include <catch2/catch.hpp>

#include "common/names/folded_name.hpp"
#include "protocol/codec/password_key.hpp"
#include "server/world/cluster/following.hpp"
#include "tests/unit/server/world/cluster/cluster_bench.hpp"

namespace runstone::test {
namespace {

PublicKey player_key(std::uint8_t who) { return key_pair_of(seed_of(who)).public_key; }

TEST_CASE("a player at a follower edits, and players at both servers get the commit",
          "[world][servers]") {
  ClusterBench bench;
  REQUIRE(bench.world(1).cluster().is_live());
  CHECK(bench.world(0).cluster().follower_count() == 1);
  CHECK(bench.join(0, 1, 1).author == 1);
  // The two servers count their sessions for themselves, so the same number is no mistake.
  const SessionAccepted accepted = bench.join(1, 1, 2);
  CHECK(accepted.author == 2);
  CHECK(accepted.resolved == 0);
  CHECK(bench.world(0).order().players().author_of(player_key(2)) == 2);
  CHECK(bench.world(1).order().players().author_of(player_key(2)) == 2);
  bench.at(0).view(1, kSmall);
  bench.at(1).view(1, kSmall);

  bench.edit(0, 1, 1, block(1));
  bench.run();
  bench.edit(1, 1, 1, block(2));
  CHECK(bench.world(1).order().head() == 1);  // a follower orders nothing
  bench.run();
  bench.edit(1, 1, 2, FillBox{{{0, 0, 0}, {20, 3, 3}}});  // two chunks
  bench.run();
  for (const std::size_t server : {0U, 1U}) {
    CAPTURE(server);
    const auto edits = bench.edits(server, 1);
    REQUIRE(edits.size() == 3);
    CHECK(edits[0].op == OperationId{1, 1, 1});
    CHECK(edits[1].op == OperationId{2, 1, 1});
    CHECK(edits[1].previous == std::vector<Sequence>{1});
    CHECK(edits[2].op == OperationId{2, 1, 2});
    CHECK(edits[2].previous == std::vector<Sequence>{2, 0});
    CHECK(edits[2].edit == EditDescriptor{FillBox{{{0, 0, 0}, {20, 3, 3}}}, {}, 1});
    CHECK(bench.sent<Commit>(server, 1).back().epoch == 1);
    CHECK(bench.world(server).order().head() == 3);
    CHECK(bench.world(server).order().durable() == 3);
    CHECK(bench.world(server).order().resolved(2, 1) == 2);
  }
  CHECK(bench.world(0).order().chunks().edited().size() == 2);
  bench.check_same_chunks(0, 1);
  CHECK(bench.world(1).order().last_record() == Version{1, 3});
  CHECK(bench.environment(1).records.empty());  // the owner writes the log
  REQUIRE(bench.database.records.size() == 3);
  CHECK(bench.database.records[2].op == OperationId{2, 1, 2});
  CHECK(bench.database.players.at(2).key == player_key(2));
  // Each author is told that its edits are durable.
  CHECK(bench.sent<Durable>(1, 1).back().seq == 3);
}

TEST_CASE("a player at a follower gets its own edit outside of its view, and no other",
          "[world][servers]") {
  ClusterBench bench;
  bench.join(0, 1, 1);
  bench.join(1, 1, 2);
  bench.edit(0, 1, 1, block(1));
  bench.edit(1, 1, 1, block(2));
  bench.run();
  CHECK(bench.edits(0, 1).size() == 1);
  const auto edits = bench.edits(1, 1);
  REQUIRE(edits.size() == 1);
  CHECK(edits[0].op == OperationId{2, 1, 1});
}

TEST_CASE("a commit at a follower has the time at which the player sent the edit",
          "[world][servers]") {
  ClusterBench bench;
  bench.join(1, 1, 2);
  bench.receive(1, 1, EditRequest{1, 77'000, {block(1), {}, 1}});
  bench.run();
  const auto edits = bench.edits(1, 1);
  REQUIRE(edits.size() == 1);
  CHECK(edits[0].submitted_us == 77'000);
}

TEST_CASE("the owner's rejections reach the player at a follower", "[world][servers]") {
  WorldConfig c = config();
  c.edit_budget = {1, 3};
  c.heights = {-10, 10};
  ClusterBench bench(1, c);
  ProtectedBox box;
  box.name = "spawn";
  box.box = {{0, 0, 0}, {8, 8, 8}};
  const auto done = bench.world(0).changes().change_rights(Protect{box}, {}, 0, bench.now());
  REQUIRE(done.has_value());
  bench.join(1, 1, 2);
  bench.edit(1, 1, 1, block(1));
  bench.edit(1, 1, 2, SetVoxel{{0, 11, 0}});
  EditRequest faulty{3, 0, {}};
  faulty.fault = Error{ErrorCode{}, "a broken edit", 5};
  bench.receive(1, 1, faulty);
  bench.run();
  bench.edit(1, 1, 4, block(9));
  bench.edit(1, 1, 5, block(10));
  bench.run();
  std::map<ClientSequence, Reject> rejects;
  for (const Reject& reject : bench.sent<Reject>(1, 1)) rejects[reject.client_seq] = reject;
  REQUIRE(rejects.size() == 4);
  CHECK(rejects.at(1).reason == RejectReason::not_permitted);
  CHECK(rejects.at(1).detail == "the ground is protected: spawn");
  CHECK(rejects.at(2).reason == RejectReason::outside_world);
  CHECK(rejects.at(3).reason == RejectReason::bad_edit);
  CHECK(rejects.at(3).detail == "a broken edit (at byte 5)");
  CHECK(rejects.at(5).reason == RejectReason::rate_limited);
  const auto edits = bench.edits(1, 1);
  REQUIRE(edits.size() == 1);
  CHECK(edits[0].op.seq == 4);
  // A rejection costs the session as much as the owner says.
  CHECK(bench.environment(1).charged[1] > 1'000);
  // They are answered, so they are not offered again.
  bench.cut(1);
  bench.connect(1);
  bench.run();
  CHECK(bench.sent<Reject>(1, 1).size() == 4);
}

TEST_CASE("an action that was rejected at a follower stays so after a lone invalid edit",
          "[world][servers]") {
  ClusterBench bench;
  bench.join(1, 1, 2);
  const auto send = [&](ClientSequence seq, ClientSequence action, bool is_faulty) {
    EditRequest request{seq, 0, {block(1), {}, 1}};
    request.action = action;
    if (is_faulty) request.fault = Error{ErrorCode{}, "a broken edit", 5};
    bench.receive(1, 1, request);
  };
  send(1, 1, true);
  send(2, 0, true);
  send(3, 1, false);
  bench.run();
  CHECK(bench.sent<Reject>(1, 1).size() == 3);
  CHECK(bench.edits(1, 1).empty());
}

TEST_CASE("a command of the owner closes the session of a banned player at a follower",
          "[world][servers][rights]") {
  ClusterBench bench;
  bench.join(1, 7, 2);
  bench.join(1, 8, 3);
  const auto done = bench.world(0).changes().change_rights(
      Restrict{RestrictionKind::ban, player_key(2), 0, "grief"}, {}, 0, bench.now());
  REQUIRE(done.has_value());
  bench.run();
  const auto end = bench.end_of(1, 7);
  REQUIRE(end.has_value());
  CHECK(end->reason == GoodbyeReason::not_admitted);
  CHECK(end->text.find("grief") != std::string::npos);
  CHECK_FALSE(bench.end_of(1, 8).has_value());
  CHECK(bench.world(0).people().online().size() == 1);
  CHECK(bench.world(1).people().online().size() == 1);
  bench.knock(1, 9, 2, bench.hello(2));
  REQUIRE(bench.end_of(1, 9).has_value());
  CHECK(bench.end_of(1, 9)->reason == GoodbyeReason::not_admitted);
  CHECK(bench.sent<SessionAccepted>(1, 9).empty());
  CHECK(bench.world(0).people().kick(player_key(3), "enough") == 1);
  bench.run();
  REQUIRE(bench.end_of(1, 8).has_value());
  CHECK(bench.end_of(1, 8)->text.find("enough") != std::string::npos);
}

TEST_CASE("an invite and a password let players in through a follower",
          "[world][servers][rights]") {
  ClusterBench bench;
  const PasswordKey right{1, 2, 3}, wrong{1, 2, 4};
  const auto change = [&](const RightsChange& what) {
    const auto done = bench.world(0).changes().change_rights(what, {}, 0, bench.now());
    INFO((done ? std::string() : done.error()));
    REQUIRE(done.has_value());
  };
  change(SetDefaultRole{kNobodyRole});
  change(SetPassword{{{kVisitorRole, {9}, hash_of(right)}}});
  change(CreateInvite{{1, kBuilderRole, 1, bench.now().utc_us + 60'000'000}});
  bench.run();
  const std::string link = bench.world(0).people().invite_link(1);
  const std::string token = link.substr(link.find('#') + 1);
  const ChannelBinding binding{5};

  bench.knock(1, 1, 1, bench.hello(1), token);
  CHECK(bench.is_open(1, 1));
  CHECK(bench.world(1).rights().state().role_of(player_key(1)).name == kBuilderRole);
  bench.knock(1, 2, 2, bench.hello(2), "", right, binding);
  CHECK(bench.sent<Welcome>(1, 2).at(0).password_salt == PasswordSalt{9});
  CHECK(bench.is_open(1, 2));
  CHECK(bench.world(1).rights().state().role_of(player_key(2)).name == kVisitorRole);
  bench.knock(1, 3, 3, bench.hello(3), "", wrong, binding);
  REQUIRE(bench.end_of(1, 3).has_value());
  CHECK(bench.end_of(1, 3)->reason == GoodbyeReason::not_admitted);
  CHECK(bench.end_of(1, 3)->text.find("the password is wrong") != std::string::npos);
  bench.knock(1, 4, 4, bench.hello(4), "", right);  // not encrypted
  REQUIRE(bench.end_of(1, 4).has_value());
  CHECK(bench.end_of(1, 4)->text.find("needs an encrypted connection") != std::string::npos);
  for (std::uint8_t who = 1; who <= 3; ++who)
    CHECK(bench.world(0).rights().state().role_of(player_key(who)).name ==
          bench.world(1).rights().state().role_of(player_key(who)).name);
}

TEST_CASE("a name is claimed through a follower, and nobody else gets it",
          "[world][servers][names]") {
  ClusterBench bench;
  Hello ana = bench.hello(2, kFeaturesKnown);
  ana.name = "Ana";
  // The owner accepts the player when the claim is on disk. run() writes it.
  bench.servers[0].names_written = 0;
  const SessionAccepted accepted = bench.join(1, 1, 2, ana);
  CHECK(accepted.author == 1);
  CHECK(bench.database.names.contains(folded_name("Ana")));
  CHECK(bench.world(1).order().names().all() == bench.world(0).order().names().all());
  for (const std::size_t server : {0U, 1U}) {
    Hello other = bench.hello(3, kFeaturesKnown);
    other.name = "ana";
    bench.knock(server, 5, 3, other);
    REQUIRE(bench.end_of(server, 5).has_value());
    CHECK(bench.end_of(server, 5)->reason == GoodbyeReason::name_refused);
  }
  REQUIRE(bench.world(0).people().names().release("Ana").has_value());
  bench.run();
  CHECK(bench.world(1).order().names().all().empty());
}

TEST_CASE("a name that is claimed on the way is refused by the owner", "[world][servers][names]") {
  ClusterBench bench;
  bench.servers[1].holds_to_owner = true;
  Hello late = bench.hello(2, kFeaturesKnown);
  late.name = "Ana";
  bench.knock(1, 1, 2, late);
  CHECK_FALSE(bench.is_open(1, 1));
  Hello first = bench.hello(3, kFeaturesKnown);
  first.name = "Ana";
  bench.join(0, 1, 3, first);
  bench.servers[1].holds_to_owner = false;
  bench.run();
  REQUIRE(bench.end_of(1, 1).has_value());
  CHECK(bench.end_of(1, 1)->reason == GoodbyeReason::name_refused);
  CHECK(bench.world(0).people().online().size() == 1);
}

TEST_CASE("the same client at another server replaces its session", "[world][servers]") {
  ClusterBench bench(2);
  bench.join(1, 1, 2);
  CHECK(bench.join(0, 1, 2).author == 1);
  REQUIRE(bench.end_of(1, 1).has_value());
  CHECK(bench.end_of(1, 1)->reason == GoodbyeReason::already_connected);
  bench.join(2, 1, 2);
  REQUIRE(bench.end_of(0, 1).has_value());
  CHECK(bench.end_of(0, 1)->reason == GoodbyeReason::already_connected);
  CHECK_FALSE(bench.end_of(2, 1).has_value());
  bench.join(2, 2, 2, bench.hello(2, kFeaturesKnown & ~kFeatureNames, 9));  // another client
  CHECK_FALSE(bench.end_of(2, 1).has_value());
  bench.join(2, 3, 2);  // through the same follower
  REQUIRE(bench.end_of(2, 1).has_value());
  CHECK(bench.end_of(2, 1)->reason == GoodbyeReason::already_connected);
  CHECK(bench.world(0).people().online().size() == 2);
}

TEST_CASE("lines, the player list and poses reach players at all servers", "[world][servers]") {
  ClusterBench bench(2);
  bench.join(0, 1, 1);
  bench.join(1, 1, 2);
  bench.join(2, 1, 3);
  bench.tick();
  for (const std::size_t server : {0U, 1U, 2U}) {
    CAPTURE(server);
    std::set<AuthorId> listed;
    for (const PlayerList& list : bench.sent<PlayerList>(server, 1)) {
      for (const PlayerName& player : list.players) listed.insert(player.author);
    }
    CHECK(listed == std::set<AuthorId>{1, 2, 3});
  }
  bench.receive(1, 1, ChatRequest{"from a follower"});
  bench.receive(0, 1, ChatRequest{"from the owner"});
  const Pose pose{{3, 4, 5}, 6, 7};
  bench.receive(2, 1, Move{pose});
  bench.pump();
  bench.time_us += 1'000'000;
  bench.tick();
  for (const std::size_t server : {0U, 1U, 2U}) {
    CAPTURE(server);
    std::set<std::string> lines;
    for (const ChatLines& part : bench.sent<ChatLines>(server, 1)) {
      for (const ChatLine& line : part.lines) {
        if (line.kind != ChatLineKind::visit) lines.insert(line.text);
      }
    }
    CHECK(lines == std::set<std::string>{"from a follower", "from the owner"});
    const auto poses = bench.sent<PlayerPoses>(server, 1);
    REQUIRE_FALSE(poses.empty());
    CHECK(std::ranges::count(poses.back().players, PlayerPose{3, pose}) == 1);
  }
  // The one who leaves a follower leaves the world.
  bench.world(2).disconnected(1);
  bench.tick();
  for (const std::size_t server : {0U, 1U})
    CHECK(bench.sent<PlayerList>(server, 1).back().left == std::vector<AuthorId>{3});
}

TEST_CASE("what the owner sends to players at a follower is sent to them in one round",
          "[world][servers]") {
  ClusterBench bench;
  bench.join(0, 1, 1);
  for (std::uint8_t i = 1; i <= 3; ++i) bench.join(1, i, static_cast<std::uint8_t>(1 + i));
  bench.tick();
  FakeEnvironment& follower = bench.environment(1);
  const auto rounds_of = [&](MessageKind kind) {
    std::vector<std::size_t> sizes;
    for (const auto& [sent, sessions] : follower.rounds) {
      if (sent == kind) sizes.push_back(sessions);
    }
    return sizes;
  };
  follower.rounds.clear();
  bench.receive(0, 1, ChatRequest{"to all"});
  bench.tick();
  CHECK(rounds_of(kKindOf<ChatLines>) == std::vector<std::size_t>{3});

  // A player who misses a change of the list of players is closed. Other messages may be missed.
  follower.full.insert(2);
  bench.receive(0, 1, ChatRequest{"once more"});
  bench.tick();
  CHECK_FALSE(bench.end_of(1, 2).has_value());
  bench.world(0).disconnected(1);
  follower.rounds.clear();
  bench.tick();
  CHECK(rounds_of(kKindOf<PlayerList>) == std::vector<std::size_t>{3});
  REQUIRE(bench.end_of(1, 2).has_value());
  CHECK(bench.end_of(1, 2)->reason == GoodbyeReason::timed_out);
  CHECK_FALSE(bench.end_of(1, 1).has_value());
  CHECK_FALSE(bench.end_of(1, 3).has_value());
}

TEST_CASE("a command of a player at a follower is carried out by the owner", "[world][servers]") {
  ClusterBench bench;
  bench.join(1, 1, 2);
  bench.receive(1, 1, CommandRequest{5, "undo"});
  bench.pump();
  REQUIRE(bench.environment(0).commands == std::vector<std::string>{"undo"});
  CHECK(bench.environment(1).commands.empty());
  const SessionId at_owner = bench.world(0).people().online().at(0).session;
  bench.world(0).people().commands().answer(at_owner, {"done"}, true, true);
  bench.pump();
  const auto output = bench.sent<CommandOutput>(1, 1);
  REQUIRE(output.size() == 1);
  CHECK(output[0].id == 5);
  CHECK(output[0].lines == std::vector<std::string>{"done"});
  bench.cut(1);
  bench.receive(1, 1, CommandRequest{6, "undo"});
  const auto answers = bench.sent<CommandOutput>(1, 1);
  REQUIRE(answers.size() == 2);
  CHECK(answers[1].id == 6);
  CHECK(answers[1].is_done);
  CHECK_FALSE(answers[1].is_ok);
}

TEST_CASE("a follower does not offer what only the owner has", "[world][servers]") {
  ClusterBench bench;
  bench.join(0, 1, 1);
  bench.join(1, 1, 2);
  const std::uint64_t at_owner = bench.sent<Welcome>(0, 1).at(0).features;
  const std::uint64_t at_follower = bench.sent<Welcome>(1, 1).at(0).features;
  CHECK(at_owner == (kFeaturesKnown & ~kFeatureNames));
  CHECK(at_follower == (at_owner & ~kFeaturesOfOwner));
  bench.receive(1, 1, PreviewShare{});
  REQUIRE(bench.end_of(1, 1).has_value());
  CHECK(bench.end_of(1, 1)->reason == GoodbyeReason::unexpected_message);
  bench.pump();
  CHECK(bench.world(0).people().online().size() == 1);
}

TEST_CASE("a player who comes while there is no owner is let in by the next one",
          "[world][servers]") {
  ClusterBench bench;
  bench.cut(1);
  bench.knock(1, 1, 2, bench.hello(2));
  CHECK_FALSE(bench.is_open(1, 1));
  CHECK_FALSE(bench.end_of(1, 1).has_value());
  bench.connect(1);
  bench.run();
  CHECK(bench.is_open(1, 1));
  CHECK(bench.sent<SessionAccepted>(1, 1).at(0).author == 1);
}

TEST_CASE("a client that cannot resume is closed when the connection with the owner is back",
          "[world][servers]") {
  ClusterBench bench;
  bench.join(1, 1, 2, bench.hello(2, kFeatureChat));
  bench.join(1, 2, 3);
  bench.cut(1);
  bench.tick();
  CHECK(bench.is_open(1, 1));
  bench.connect(1);
  bench.run();
  REQUIRE(bench.end_of(1, 1).has_value());
  CHECK(bench.end_of(1, 1)->reason == GoodbyeReason::closing);
  CHECK(bench.is_open(1, 2));
  bench.run();
  CHECK(bench.world(0).people().online().size() == 1);
}

TEST_CASE(
    "edits that arrive before the owner knows of the session again are offered again, in order",
    "[world][servers]") {
  ClusterBench bench;
  bench.join(1, 1, 2);
  bench.cut(1);
  bench.edit(1, 1, 1, block(1));  // lost
  bench.servers[1].holds_when_live = true;
  bench.connect(1);
  bench.run();
  REQUIRE(bench.world(1).cluster().is_live());
  REQUIRE(bench.sent<Resume>(1, 1).empty());
  bench.edit(1, 1, 2, block(2));  // the owner would order it before the first one
  bench.servers[1].holds_when_live = false;
  bench.run();
  std::vector<ClientSequence> mine;
  for (const OrderedEdit& edit : bench.edits(1, 1)) mine.push_back(edit.op.seq);
  CHECK(mine == std::vector<ClientSequence>{1, 2});
  CHECK(bench.sent<Reject>(1, 1).empty());
}

TEST_CASE("every gap in the connection is answered before edits count again", "[world][servers]") {
  ClusterBench bench;
  bench.join(1, 1, 2);
  bench.answers_resumes = false;
  for (int i = 0; i < 2; ++i) {
    bench.cut(1);
    bench.connect(1);
    bench.run();
  }
  CHECK(bench.sent<Resume>(1, 1).size() == 2);
  bench.receive(1, 1, Resumed{});  // the first one: what follows it may have been lost
  bench.edit(1, 1, 1, block(1));
  bench.run();
  CHECK(bench.world(0).order().head() == 0);
  bench.receive(1, 1, Resumed{});
  bench.edit(1, 1, 1, block(1));
  bench.run();
  CHECK(bench.world(0).order().head() == 1);
}

TEST_CASE("a session that waits at a follower does not replace the client's newer one",
          "[world][servers]") {
  ClusterBench bench;
  bench.join(1, 1, 2);
  bench.cut(1);
  bench.join(0, 1, 2);  // the client has come to the owner
  bench.connect(1);
  bench.run();
  CHECK(bench.is_open(0, 1));
  REQUIRE(bench.end_of(1, 1).has_value());
  CHECK(bench.end_of(1, 1)->reason == GoodbyeReason::already_connected);
}

TEST_CASE("a follower tells its players that the owner's disk is full", "[world][servers]") {
  ClusterBench bench;
  bench.join(1, 1, 2);
  bench.tick();
  bench.world(0).set_disk_is_full(true, bench.now());
  bench.tick();
  REQUIRE_FALSE(bench.sent<Durable>(1, 1).empty());
  CHECK(bench.sent<Durable>(1, 1).back().is_read_only);
  bench.edit(1, 1, 1, block(1));
  bench.run();
  REQUIRE(bench.sent<Reject>(1, 1).size() == 1);
  CHECK(bench.sent<Reject>(1, 1)[0].reason == RejectReason::busy);
  bench.world(0).set_disk_is_full(false, bench.now());
  bench.tick();
  bench.tick(1'000'000);
  CHECK_FALSE(bench.sent<Durable>(1, 1).back().is_read_only);
}

TEST_CASE("a follower measures how long the edits of its players wait for the owner",
          "[world][servers]") {
  ClusterBench bench;
  bench.join(0, 1, 1);
  bench.join(1, 1, 2);
  bench.join(1, 2, 3);
  bench.servers[1].holds_to_owner = true;
  bench.edit(1, 1, 1, kAtOrigin);
  bench.edit(1, 2, 1, kAtOrigin);
  bench.receive(1, 1, EditRequest{2, 0, {FillBox{{{0, 0, 0}, {4'000, 4'000, 4'000}}}, {}, 1}});
  bench.at(1).time_us = (bench.time_us += 30'000);
  bench.edit(0, 1, 1, kAtOrigin);
  bench.world(1).disconnected(2);  // nobody waits for its edit
  bench.servers[1].holds_to_owner = false;
  bench.run();
  CHECK(bench.sent<Reject>(1, 1).size() == 1);
  CHECK(bench.world(1).order().authority().edit_waits().count() == 1);
  CHECK(bench.world(1).order().authority().edit_waits().sum_us() == 30'000);
  CHECK(bench.world(0).order().authority().edit_waits().count() == 3);
  // An edit whose answer was lost with a connection is not measured.
  bench.servers[1].holds_to_owner = true;
  bench.edit(1, 1, 3, kAtOrigin);
  bench.cut(1);
  bench.servers[1].holds_to_owner = false;
  bench.connect(1);
  for (int i = 0; i < 3; ++i) bench.tick();
  CHECK(bench.world(1).order().last_record().seq == 4);
  CHECK(bench.world(1).order().authority().edit_waits().count() == 2);  // when it was offered again
}

TEST_CASE("a player whose session goes on gets neither old lines nor all poses again",
          "[world][servers]") {
  WorldConfig c = config();
  c.message_of_the_day = "today";
  ClusterBench bench(2, c);
  for (std::size_t server = 0; server < 3; ++server)
    bench.join(server, 1, static_cast<std::uint8_t>(server + 1));
  bench.receive(2, 1, ChatRequest{"a line"});
  for (int i = 0; i < 40; ++i) bench.tick();
  const std::size_t lines = bench.sent<ChatLines>(2, 1).size();
  CHECK(lines == 2);  // that of the day, and this one
  const std::size_t poses = bench.sent<PlayerPoses>(2, 1).size();
  SECTION("the connection breaks") {
    bench.cut(2);
    bench.connect(2);
  }
  SECTION("another server owns the world") {
    bench.lose_owner();
    REQUIRE(bench.take_over(1));
    bench.connect(2);
  }
  bench.run();
  CHECK(bench.sent<Resume>(2, 1).size() == 1);
  CHECK(bench.sent<ChatLines>(2, 1).size() == lines);
  CHECK(bench.sent<PlayerPoses>(2, 1).size() == poses);
  for (int i = 0; i < 40; ++i) bench.tick();
  CHECK(bench.sent<ChatLines>(2, 1).size() == lines);
  // Poses that changed in the gap are among those that every player gets.
  CHECK(bench.sent<PlayerPoses>(2, 1).size() > poses);
}

}  // namespace
}  // namespace runstone::test
