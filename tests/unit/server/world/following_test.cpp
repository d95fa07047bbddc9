// What a server does while it follows the owner of its world.
#include "server/world/following.hpp"

#include <catch2/catch.hpp>
#include <variant>

#include "common/names/folded_name.hpp"
#include "protocol/codec/message_table.hpp"
#include "protocol/codec/password_key.hpp"
#include "tests/unit/server/world/cluster_bench.hpp"

namespace runstone::test {
namespace {

PublicKey follower_player(std::uint8_t who) { return key_pair_of(seed_of(who)).public_key; }

SetVoxel voxel(std::int32_t x) { return {{x, 1, 1}}; }

TEST_CASE("a player at a follower edits, and players at both servers get the commit",
          "[world][servers]") {
  ClusterBench bench;
  REQUIRE(bench.world(1).is_live());
  CHECK(bench.world(0).follower_count() == 1);
  CHECK(bench.join(0, 1, 1).author == 1);
  // The two servers count their sessions for themselves, so the same number is no mistake.
  const SessionAccepted accepted = bench.join(1, 1, 2);
  CHECK(accepted.author == 2);
  CHECK(accepted.resolved == 0);
  CHECK(bench.world(0).author_of(follower_player(2)) == 2);
  CHECK(bench.world(1).author_of(follower_player(2)) == 2);
  bench.at(0).view(1, kSmall);
  bench.at(1).view(1, kSmall);

  bench.edit(0, 1, 1, voxel(1));
  bench.run();
  bench.edit(1, 1, 1, voxel(2));
  CHECK(bench.world(1).head() == 1);  // a follower orders nothing
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
    CHECK(bench.world(server).head() == 3);
    CHECK(bench.world(server).durable() == 3);
    CHECK(bench.world(server).resolved(2, 1) == 2);
  }
  CHECK(bench.world(0).edited_chunks().size() == 2);
  bench.check_same_chunks(0, 1);
  CHECK(bench.world(1).last_record() == Version{1, 3});
  CHECK(bench.environment(1).records.empty());  // the owner writes the log
  REQUIRE(bench.database.records.size() == 3);
  CHECK(bench.database.records[2].op == OperationId{2, 1, 2});
  CHECK(bench.database.players.at(2).key == follower_player(2));
  // Each author is told that its edits are durable.
  CHECK(bench.sent<Durable>(1, 1).back().seq == 3);
}

TEST_CASE("a player at a follower gets its own edit outside of its view, and no other",
          "[world][servers]") {
  ClusterBench bench;
  bench.join(0, 1, 1);
  bench.join(1, 1, 2);
  bench.edit(0, 1, 1, voxel(1));
  bench.edit(1, 1, 1, voxel(2));
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
  bench.receive(1, 1, EditRequest{1, 77'000, {voxel(1), {}, 1}});
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
  const auto done = bench.world(0).change_rights(Protect{box}, {}, 0, bench.now());
  REQUIRE(done.has_value());
  bench.join(1, 1, 2);
  bench.edit(1, 1, 1, voxel(1));
  bench.edit(1, 1, 2, SetVoxel{{0, 11, 0}});
  EditRequest faulty{3, 0, {}};
  faulty.fault = Error{ErrorCode{}, "a broken edit", 5};
  bench.receive(1, 1, faulty);
  bench.run();
  bench.edit(1, 1, 4, voxel(9));
  bench.edit(1, 1, 5, voxel(10));
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

TEST_CASE("a command of the owner closes the session of a banned player at a follower",
          "[world][servers][rights]") {
  ClusterBench bench;
  bench.join(1, 7, 2);
  bench.join(1, 8, 3);
  const auto done = bench.world(0).change_rights(
      Restrict{RestrictionKind::ban, follower_player(2), 0, "grief"}, {}, 0, bench.now());
  REQUIRE(done.has_value());
  bench.run();
  const auto end = bench.end_of(1, 7);
  REQUIRE(end.has_value());
  CHECK(end->reason == GoodbyeReason::not_admitted);
  CHECK(end->text.find("grief") != std::string::npos);
  CHECK_FALSE(bench.end_of(1, 8).has_value());
  CHECK(bench.world(0).online_players().size() == 1);
  CHECK(bench.world(1).online_players().size() == 1);
  bench.knock(1, 9, 2, bench.hello(2));
  REQUIRE(bench.end_of(1, 9).has_value());
  CHECK(bench.end_of(1, 9)->reason == GoodbyeReason::not_admitted);
  CHECK(bench.sent<SessionAccepted>(1, 9).empty());
  CHECK(bench.world(0).kick(follower_player(3), "enough") == 1);
  bench.run();
  REQUIRE(bench.end_of(1, 8).has_value());
  CHECK(bench.end_of(1, 8)->text.find("enough") != std::string::npos);
}

TEST_CASE("an invite and a password let players in through a follower",
          "[world][servers][rights]") {
  ClusterBench bench;
  const PasswordKey right{1, 2, 3}, wrong{1, 2, 4};
  const auto change = [&](const RightsChange& what) {
    const auto done = bench.world(0).change_rights(what, {}, 0, bench.now());
    INFO((done ? std::string() : done.error()));
    REQUIRE(done.has_value());
  };
  change(SetDefaultRole{kNobodyRole});
  change(SetPassword{{{kVisitorRole, {9}, hash_of(right)}}});
  change(CreateInvite{{1, kBuilderRole, 1, bench.now().utc_us + 60'000'000}});
  bench.run();
  const std::string link = bench.world(0).invite_link(1);
  const std::string token = link.substr(link.find('#') + 1);
  const ChannelBinding binding{5};

  bench.knock(1, 1, 1, bench.hello(1), token);
  CHECK(bench.is_open(1, 1));
  CHECK(bench.world(1).rights().role_of(follower_player(1)).name == kBuilderRole);
  bench.knock(1, 2, 2, bench.hello(2), "", right, binding);
  CHECK(bench.sent<Welcome>(1, 2).at(0).password_salt == PasswordSalt{9});
  CHECK(bench.is_open(1, 2));
  CHECK(bench.world(1).rights().role_of(follower_player(2)).name == kVisitorRole);
  bench.knock(1, 3, 3, bench.hello(3), "", wrong, binding);
  REQUIRE(bench.end_of(1, 3).has_value());
  CHECK(bench.end_of(1, 3)->reason == GoodbyeReason::not_admitted);
  CHECK(bench.end_of(1, 3)->text.find("the password is wrong") != std::string::npos);
  bench.knock(1, 4, 4, bench.hello(4), "", right);  // not encrypted
  REQUIRE(bench.end_of(1, 4).has_value());
  CHECK(bench.end_of(1, 4)->text.find("needs an encrypted connection") != std::string::npos);
  for (std::uint8_t who = 1; who <= 3; ++who)
    CHECK(bench.world(0).rights().role_of(follower_player(who)).name ==
          bench.world(1).rights().role_of(follower_player(who)).name);
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
  CHECK(bench.world(1).name_claims() == bench.world(0).name_claims());
  for (const std::size_t server : {0U, 1U}) {
    Hello other = bench.hello(3, kFeaturesKnown);
    other.name = "ana";
    bench.knock(server, 5, 3, other);
    REQUIRE(bench.end_of(server, 5).has_value());
    CHECK(bench.end_of(server, 5)->reason == GoodbyeReason::name_refused);
  }
  REQUIRE(bench.world(0).release_name("Ana").has_value());
  bench.run();
  CHECK(bench.world(1).name_claims().empty());
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
  CHECK(bench.world(0).online_players().size() == 1);
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
  CHECK(bench.world(0).online_players().size() == 2);
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
      for (const ChatLine& line : part.lines) lines.insert(line.text);
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

TEST_CASE("a command of a player at a follower is carried out by the owner", "[world][servers]") {
  ClusterBench bench;
  bench.join(1, 1, 2);
  bench.receive(1, 1, CommandRequest{5, "undo"});
  bench.pump();
  REQUIRE(bench.environment(0).commands == std::vector<std::string>{"undo"});
  CHECK(bench.environment(1).commands.empty());
  const SessionId at_owner = bench.world(0).online_players().at(0).session;
  bench.world(0).answer_command(at_owner, {"done"}, true, true);
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
  CHECK(bench.world(0).online_players().size() == 1);
}

TEST_CASE("a follower that connects late reads what it lacks, and holds the rest back",
          "[world][servers]") {
  ClusterBench bench(0);
  bench.join(0, 1, 1);
  for (ClientSequence seq = 1; seq <= 3; ++seq) {
    bench.edit(0, 1, seq, voxel(static_cast<std::int32_t>(seq)));
    bench.run();
  }
  const std::size_t late = bench.add_follower();  // it has 3 records
  CHECK(bench.world(late).head() == 3);
  for (ClientSequence seq = 4; seq <= 8; ++seq) {
    bench.edit(0, 1, seq, voxel(static_cast<std::int32_t>(seq)));
    bench.run();
  }
  bench.read_records_max = 3;  // the one that it has, and two more
  bench.servers[late].holds_reads = true;
  bench.connect(late);
  bench.pump();
  REQUIRE(bench.environment(late).log_reads == std::deque<Sequence>{3});
  CHECK_FALSE(bench.world(late).is_live());
  bench.edit(0, 1, 9, voxel(9));
  bench.run();
  CHECK(bench.servers[late].parts.size() == 1);
  CHECK(bench.world(late).head() == 3);  // record 9 waits
  bench.servers[late].holds_reads = false;
  for (int i = 0; i < 10 && !bench.world(late).is_live(); ++i) bench.tick();
  CHECK(bench.world(late).is_live());
  CHECK(bench.world(late).head() == 9);
  CHECK(bench.world(late).last_record() == Version{1, 9});
  CHECK(bench.world(late).resolved(1, 1) == 9);
  CHECK(bench.world(late).author_of(follower_player(1)) == 1);
  bench.at(0).view(1, kSmall);
  bench.join(late, 1, 2);
  bench.at(late).view(1, kSmall);
  bench.check_same_chunks(0, late);
}

TEST_CASE("a player who waits for the owner at a late follower gets every commit once",
          "[world][servers]") {
  ClusterBench bench(1, config(), false);
  bench.join(0, 1, 1);
  bench.join(1, 1, 2);
  bench.at(1).view(1, kSmall);
  bench.edit(0, 1, 1, voxel(1));
  bench.run();
  bench.cut(1);
  bench.durable_max = 3;
  for (ClientSequence seq = 2; seq <= 5; ++seq) {
    bench.edit(0, 1, seq, voxel(static_cast<std::int32_t>(seq)));
    bench.run();
  }
  bench.connect(1);
  bench.tick();
  bench.edit(0, 1, 6, voxel(6));
  for (int i = 0; i < 5; ++i) bench.tick();
  // Records 4 and 5 are not durable. So the reader does not find them, and 6 waits.
  CHECK_FALSE(bench.world(1).is_live());
  CHECK(bench.world(1).head() == 3);
  CHECK(bench.sequences(1, 1) == std::vector<Sequence>{1, 2, 3});
  bench.durable_max = 4;
  for (int i = 0; i < 5; ++i) bench.tick();
  CHECK_FALSE(bench.world(1).is_live());
  CHECK(bench.sequences(1, 1) == std::vector<Sequence>{1, 2, 3, 4});
  bench.durable_max = 6;
  for (int i = 0; i < 5; ++i) bench.tick();
  CHECK(bench.world(1).is_live());
  CHECK(bench.sequences(1, 1) == std::vector<Sequence>{1, 2, 3, 4, 5, 6});
  for (const OrderedEdit& edit : bench.edits(1, 1))
    CHECK(edit.previous == std::vector<Sequence>{edit.seq - 1});
  CHECK(bench.world(1).durable() == 6);
}

TEST_CASE(
    "sessions stay when the connection with the owner ends, and their edits are offered again",
    "[world][servers]") {
  ClusterBench bench;
  bench.join(0, 1, 1);
  const AuthorId author = bench.join(1, 1, 2).author;
  bench.edit(1, 1, 1, voxel(1));
  bench.run();
  // The owner orders the second edit, but its records do not arrive.
  bench.servers[1].holds_from_owner = true;
  bench.edit(1, 1, 2, voxel(2));
  bench.run();
  CHECK(bench.world(0).head() == 2);
  CHECK(bench.world(1).head() == 1);
  // The third one is lost on the way.
  bench.servers[1].holds_to_owner = true;
  bench.edit(1, 1, 3, voxel(3));
  bench.cut(1);
  bench.servers[1].holds_from_owner = bench.servers[1].holds_to_owner = false;
  CHECK_FALSE(bench.world(1).is_live());
  CHECK(bench.is_open(1, 1));
  CHECK(bench.world(0).online_players().size() == 1);  // the owner has lost the player
  bench.edit(1, 1, 4, voxel(4));
  bench.receive(1, 1, Move{Pose{{7, 8, 9}, 0, 0}});
  bench.tick();
  CHECK(bench.world(1).head() == 1);
  bench.edit(0, 1, 1, voxel(5));
  bench.tick();

  bench.connect(1);
  for (int i = 0; i < 3; ++i) bench.tick();
  CHECK(bench.world(1).is_live());
  CHECK(bench.is_open(1, 1));
  CHECK_FALSE(bench.end_of(1, 1).has_value());
  CHECK(bench.sent<SessionAccepted>(1, 1).size() == 1);  // the session just goes on
  REQUIRE(bench.world(0).online_players().size() == 2);
  CHECK(bench.world(0).online_players()[1].author == author);
  CHECK(bench.world(0).online_players()[1].at == WorldPos{7, 8, 9});
  std::vector<ClientSequence> mine;
  for (const OrderedEdit& edit : bench.edits(1, 1)) {
    if (edit.op.author == author) mine.push_back(edit.op.seq);
  }
  CHECK(mine == std::vector<ClientSequence>{1, 2, 3, 4});
  CHECK(bench.world(0).head() == 5);
  CHECK(bench.database.records.size() == 5);
  CHECK(bench.sent<Reject>(1, 1).empty());
}

TEST_CASE("an edit that the owner orders while a follower connects again is applied once",
          "[world][servers]") {
  ClusterBench bench;
  bench.join(1, 1, 2);
  bench.edit(1, 1, 1, voxel(1));
  bench.pump();  // the owner has it, and has not ordered it
  bench.cut(1);
  bench.servers[1].holds_from_owner = true;
  bench.connect(1);
  bench.servers[1].holds_from_owner = false;
  bench.pump();
  bench.run();
  bench.tick();
  CHECK(bench.world(0).head() == 1);
  CHECK(bench.sequences(1, 1) == std::vector<Sequence>{1});
  bench.edit(1, 1, 2, voxel(2));
  bench.run();
  CHECK(bench.sequences(1, 1) == std::vector<Sequence>{1, 2});
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
  CHECK(bench.world(0).online_players().size() == 1);
}

TEST_CASE(
    "edits that arrive before the owner knows of the session again are offered again, in order",
    "[world][servers]") {
  ClusterBench bench;
  bench.join(1, 1, 2);
  bench.cut(1);
  bench.edit(1, 1, 1, voxel(1));  // lost
  bench.servers[1].holds_when_live = true;
  bench.connect(1);
  bench.run();
  REQUIRE(bench.world(1).is_live());
  REQUIRE(bench.sent<Resume>(1, 1).empty());
  bench.edit(1, 1, 2, voxel(2));  // the owner would order it before the first one
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
  bench.edit(1, 1, 1, voxel(1));
  bench.run();
  CHECK(bench.world(0).head() == 0);
  bench.receive(1, 1, Resumed{});
  bench.edit(1, 1, 1, voxel(1));
  bench.run();
  CHECK(bench.world(0).head() == 1);
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
    bench.edit(1, 1, 1, voxel(1));
  }
  SECTION("a gap") {
    LogPart part;
    part.records.push_back({{{1, 2}, {1, 1, 1}, 5, Cause::player, {voxel(1), {}, 1}}, 0});
    bench.world(1).owner_received(part, bench.now());
  }
  CHECK(bench.environment(1).owners_left.size() == 1);
  CHECK_FALSE(bench.world(1).is_live());
  CHECK(bench.world(1).head() == 0);
  CHECK(bench.is_open(1, 1));
}

TEST_CASE("a follower believes no server that has not the world's key", "[world][servers]") {
  ClusterBench bench(0);
  const std::size_t follower = bench.add_follower();
  WorldConfig other = config();
  other.server_keys = key_pair_of(seed_of(99));
  WorldBench impostor(other);
  const auto welcome_from = [&](WorldBench& from, SessionId session) {
    bench.world(follower).owner_connected(std::nullopt, bench.now());
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
    bench.world(follower).owner_received(welcome, bench.now());
    CHECK(bench.environment(follower).to_owner.empty());
    return bench.environment(follower).owners_left.size() == before + 1;
  };
  CHECK(refused(welcome_from(impostor, 1)));
  Welcome forged = welcome_from(bench.at(0), 1);
  ++forged.challenge[0];
  CHECK(refused(forged));
  Welcome no_server = welcome_from(bench.at(0), 2);
  bench.world(follower).owner_received(no_server, bench.now());
  CHECK(bench.environment(follower).to_owner.size() == 1);  // client auth
}

TEST_CASE("a follower tells its players that the owner's disk is full", "[world][servers]") {
  ClusterBench bench;
  bench.join(1, 1, 2);
  bench.tick();
  bench.world(0).set_disk_is_full(true, bench.now());
  bench.tick();
  REQUIRE_FALSE(bench.sent<Durable>(1, 1).empty());
  CHECK(bench.sent<Durable>(1, 1).back().is_read_only);
  bench.edit(1, 1, 1, voxel(1));
  bench.run();
  REQUIRE(bench.sent<Reject>(1, 1).size() == 1);
  CHECK(bench.sent<Reject>(1, 1)[0].reason == RejectReason::busy);
  bench.world(0).set_disk_is_full(false, bench.now());
  bench.tick();
  bench.tick(1'000'000);
  CHECK_FALSE(bench.sent<Durable>(1, 1).back().is_read_only);
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
  const ChunkPtr saved = bench.world(0).find_chunk(key);
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
    CHECK(bench.world(1).find_chunk(key) == nullptr);
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
  REQUIRE(bench.world(1).find_chunk(key) != nullptr);
  CHECK(bench.world(1).find_chunk(key)->version == Version{1, 1});
  CHECK(bench.world(1).find_chunk(key)->digest == saved->digest);
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
  CHECK(bench.world(1).dirty_chunks() == 2);
  CHECK(bench.world(1).memory().stacked > 0);
  bench.world(1).disconnected(1);
  for (int i = 0; i < 3; ++i) bench.tick();
  CHECK(bench.world(1).resident_chunks() == 1);  // only the log has its edit
  bench.world(1).checkpoint_moved(1);
  CHECK(bench.world(1).dirty_chunks() == 1);
  CHECK(bench.world(1).memory().stacked > 0);
  for (int i = 0; i < 3; ++i) bench.tick();
  CHECK(bench.world(1).resident_chunks() == 0);
  bench.world(1).checkpoint_moved(2);
  CHECK(bench.world(1).dirty_chunks() == 0);
  CHECK(bench.world(1).memory().stacked == 0);
  CHECK(bench.world(1).chunk_version({0, {2, 0, 0}}) == Version{1, 2});
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
  bench.world(1).checkpoint_moved(1);
  bench.at(1).answer_loads();
  REQUIRE(bench.world(1).find_chunk(key) != nullptr);
  CHECK(bench.world(1).find_chunk(key)->version == Version{1, 1});
  CHECK(bench.world(1).counters().chunks_failed == 0);
  bench.world(1).checkpoint_moved(1);
  CHECK(bench.world(1).dirty_chunks() == 0);
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
  CHECK_FALSE(bench.world(late).is_live());  // it waits for the record that is not durable
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
  CHECK_FALSE(bench.world(late).has_forked());
  bench.cut(late);
  bench.connect(late);
  for (int i = 0; i < 4; ++i) bench.tick();
  CHECK(bench.world(late).is_live());
  CHECK(bench.world(late).last_record() == Version{2, 3});
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
  REQUIRE(bench.world(follower).last_record() == Version{2, 1});
  LogPart part = bench.servers[follower].parts.back();
  REQUIRE(part.records.size() == 1);
  part.records[0].record.version = {1, 2};
  bench.world(follower).owner_received(part, bench.now());
  CHECK(bench.world(follower).last_record() == Version{2, 1});
  REQUIRE(bench.environment(follower).owners_left.size() == 1);
  CHECK(bench.environment(follower).owners_left[0] == "another server has taken the world over");
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
  CHECK(bench.world(1).edit_waits().count() == 1);
  CHECK(bench.world(1).edit_waits().sum_us() == 30'000);
  CHECK(bench.world(0).edit_waits().count() == 3);
  // What a lost connection leaves without an answer is not measured.
  bench.servers[1].holds_to_owner = true;
  bench.edit(1, 1, 3, kAtOrigin);
  bench.cut(1);
  bench.servers[1].holds_to_owner = false;
  bench.connect(1);
  for (int i = 0; i < 3; ++i) bench.tick();
  CHECK(bench.world(1).last_record().seq == 4);
  CHECK(bench.world(1).edit_waits().count() == 2);  // when it was offered again
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
