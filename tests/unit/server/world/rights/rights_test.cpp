// What rights allow on the world strand: who joins, who edits where, and who changes rights.
#include <catch2/catch.hpp>

#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {
namespace {

constexpr AddressBlock kHome = address_block_v4(0x0a000001),
                       kElsewhere = address_block_v4(0x0a000101);
const RightsActor kConsole;

PublicKey key_of(std::uint8_t who) { return key_pair_of(seed_of(who)).public_key; }

ProtectedBox spawn_box() {
  ProtectedBox box;
  box.name = "spawn";
  box.box = {{0, 0, 0}, {8, 8, 8}};
  return box;
}

struct RightsBench : WorldBench {
  using WorldBench::WorldBench;

  Sequence change(const RightsChange& change) {
    const auto done = server.changes().change_rights(change, kConsole, 0, now());
    INFO((done ? std::string() : done.error()));
    REQUIRE(done.has_value());
    return *done;
  }
  std::string refusal(const RightsChange& change, std::uint8_t who, AuthorId author) {
    const auto done = server.changes().change_rights(change, {key_of(who), false}, author, now());
    return done ? "" : done.error();
  }
  std::vector<Reject> rejects(SessionId session) const {
    return environment.messages<Reject>(session, kEdge);
  }
  /// Does the handshake as `who` and returns how the server closed the session.
  FakeEnvironment::Closed refused_join(SessionId session, std::uint8_t who) {
    knock(session, who, "");
    REQUIRE_FALSE(environment.closed.empty());
    REQUIRE(environment.closed.back().session == session);
    return environment.closed.back();
  }
  std::string token_of(InviteId id) const {
    const std::string link = server.people().invite_link(id);
    return link.substr(link.find('#') + 1);
  }
};

/// Returns the start of a server on the log that another one wrote.
WorldStart start_after(const FakeEnvironment& environment) {
  WorldStart start;
  start.players = environment.players;
  for (const EditRecord& record : environment.records) {
    start.log = {record.version.epoch + 1, record.version.seq, record.version.epoch,
                 record.time_us};
    if (const RightsChange* change = rights_change_of(record.edit))
      start.rights.push_back({*change, {record.version.seq, record.op.author, record.time_us}});
  }
  return start;
}

TEST_CASE("an edit that touches protected ground is rejected as a whole and names the box",
          "[world][rights]") {
  RightsBench bench;
  bench.join(1, 1);
  bench.change(Protect{spawn_box()});
  bench.edit(1, 1, SetVoxel{{7, 7, 7}});
  bench.edit(1, 2, SetVoxel{{8, 7, 7}});
  bench.edit(1, 3, FillSphere{{12, 4, 4}, 4});  // its nearest voxel is x = 8
  bench.edit(1, 4, FillSphere{{12, 4, 4}, 5});
  bench.tick();
  const auto rejects = bench.rejects(1);
  REQUIRE(rejects.size() == 2);
  CHECK(rejects[0].client_seq == 1);
  CHECK(rejects[1].client_seq == 4);
  for (const Reject& reject : rejects) {
    CHECK(reject.reason == RejectReason::not_permitted);
    CHECK(reject.detail == "the ground is protected: spawn");
  }
  REQUIRE(bench.server.rights().refusals().size() == 1);
  CHECK(bench.server.rights().refusals()[0].what == "edit: the ground is protected: spawn");
  CHECK(bench.server.rights().refusals()[0].count == 2);
  CHECK(bench.server.order().head() == 3);

  ProtectedBox with_member = spawn_box();
  with_member.members = {key_of(1)};
  bench.change(Protect{with_member});
  bench.edit(1, 5, SetVoxel{{7, 7, 7}});
  bench.tick();
  CHECK(bench.rejects(1).size() == 2);
}

TEST_CASE("a change of rights is a record of the log that no player receives", "[world][rights]") {
  RightsBench bench;
  bench.join(1, 1);
  bench.view(1, kSmall);
  bench.edit(1, 1, kAtOrigin);
  bench.tick();
  const std::size_t commits = bench.commits(1).size();
  CHECK(bench.change(Protect{spawn_box()}) == 2);
  bench.tick();
  CHECK(bench.commits(1).size() == commits);
  const EditRecord& record = bench.environment.records.back();
  CHECK(record.version.seq == 2);
  CHECK(record.cause == Cause::rights);
  CHECK(record.op.author == 0);
  REQUIRE(rights_change_of(record.edit) != nullptr);
  CHECK(*rights_change_of(record.edit) == RightsChange(Protect{spawn_box()}));
  CHECK(validate_fields(record).has_value());
}

TEST_CASE("rights are what the log says after a restart", "[world][rights]") {
  RightsBench before;
  before.change(Protect{spawn_box()});
  before.change(Restrict{RestrictionKind::ban, key_of(2), 0, "griefing"});
  before.change(GrantRole{key_of(3), kVisitorRole});
  RightsBench after(config(), start_after(before.environment));
  after.join(1, 1);
  after.edit(1, 1, SetVoxel{{1, 1, 1}});
  after.tick();
  REQUIRE(after.rejects(1).size() == 1);
  CHECK(after.rejects(1)[0].reason == RejectReason::not_permitted);
  CHECK(after.refused_join(2, 2).text == "you are banned: griefing");
  after.join(3, 3);
  after.edit(3, 1, SetVoxel{{100, 1, 1}});
  after.tick();
  REQUIRE(after.rejects(3).size() == 1);
  CHECK(after.rejects(3)[0].detail == "your role does not allow it: visitor");
  CHECK(after.server.rights().state().boxes().size() == 1);
}

TEST_CASE("a ban closes the session, ends by the log's time, and can be lifted",
          "[world][rights]") {
  RightsBench bench;
  bench.join(1, 1);
  bench.join(2, 2);
  const TimeUs until = bench.now().utc_us + 60'000'000;
  bench.change(Restrict{RestrictionKind::ban, key_of(1), until, "griefing"});
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].session == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::not_admitted);
  CHECK(bench.refused_join(3, 1).reason == GoodbyeReason::not_admitted);
  bench.tick(61'000'000);
  bench.join(4, 1);

  bench.change(Restrict{RestrictionKind::ban, key_of(2), 0, ""});
  CHECK(bench.refused_join(5, 2).text == "you are banned");
  bench.change(Lift{RestrictionKind::ban, key_of(2)});
  bench.join(6, 2);
}

TEST_CASE("a ban of addresses is refused at hello, before any signature", "[world][rights]") {
  RightsBench bench;
  bench.change(Restrict{RestrictionKind::ban, AddressRange{address_block_v4(0x0a000000), 32 + 24},
                        0, "a bot net"});
  bench.server.connected(1, bench.now(), kHome);
  bench.server.received(1, bench.hello(1), bench.now());
  REQUIRE(bench.environment.closed.size() == 1);
  const auto closed = bench.environment.closed[0];
  CHECK(closed.reason == GoodbyeReason::not_admitted);
  CHECK(closed.text == "your address is banned: a bot net");
  CHECK(bench.environment.messages<Welcome>(1, 0).empty());
  bench.join(2, 2, 1, kElsewhere);
}

TEST_CASE("a player without the rights sees, and neither edits nor looks back", "[world][rights]") {
  RightsBench bench;
  bench.change(DefineRole{{"guest", {Right::see}, 0, 0, 0}});
  bench.change(SetDefaultRole{"guest"});
  bench.join(1, 1);
  bench.view(1, kSmall);
  CHECK_FALSE(bench.environment.snapshots.empty());
  bench.edit(1, 1, kAtOrigin);
  bench.tick();
  REQUIRE(bench.rejects(1).size() == 1);
  CHECK(bench.rejects(1)[0].detail == "your role does not allow it: guest");
  HistoryRequest past;
  past.request = 1;
  past.to = HistoryTarget::sequence;
  past.seq = 1;
  bench.server.received(1, past, bench.now());
  bench.tick();
  CHECK(bench.environment.history_requests.empty());
  const auto states = bench.environment.messages<ViewState>(1, kEdge);
  REQUIRE_FALSE(states.empty());
  CHECK(states.back().phase == ViewPhase::refused);
}

TEST_CASE("a role that may not see closes the sessions of its players", "[world][rights]") {
  RightsBench bench;
  bench.join(1, 1);
  bench.change(DefineRole{{"nobody", {}, 0, 0, 0}});
  bench.change(GrantRole{key_of(1), "nobody"});
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].text == "only invited players may join: your role is nobody");
}

TEST_CASE("players change rights as far as their role goes, and the record names them",
          "[world][rights]") {
  RightsBench bench;
  const AuthorId one = bench.join(1, 1).author, two = bench.join(2, 2).author;
  CHECK_FALSE(bench.refusal(GrantRole{key_of(2), kVisitorRole}, 1, one).empty());
  CHECK_FALSE(bench.refusal(Protect{spawn_box()}, 1, one).empty());
  bench.change(GrantRole{key_of(1), kAdministratorRole});
  CHECK(bench.refusal(GrantRole{key_of(2), kModeratorRole}, 1, one).empty());
  CHECK(bench.environment.records.back().op.author == one);
  CHECK(bench.environment.players.back().author == one);  // the author of a record has a row
  CHECK_FALSE(bench.refusal(Restrict{RestrictionKind::ban, key_of(1), 0, ""}, 2, two).empty());
  const auto locked_out = bench.server.changes().change_rights(GrantRole{key_of(1), kBuilderRole},
                                                               kConsole, 0, bench.now());
  REQUIRE_FALSE(locked_out.has_value());
  CHECK(locked_out.error().find("administrator") != std::string::npos);
}

TEST_CASE("operators of the settings have every right", "[world][rights]") {
  WorldConfig with_operator = config();
  with_operator.operators = {key_of(1)};
  RightsBench bench(with_operator);
  bench.change(Protect{spawn_box()});
  bench.change(SetDefaultRole{kVisitorRole});
  bench.join(1, 1);
  bench.edit(1, 1, SetVoxel{{1, 1, 1}});
  bench.tick();
  CHECK(bench.rejects(1).empty());
  const AuthorId two = bench.join(2, 2).author;
  bench.change(GrantRole{key_of(2), kModeratorRole});
  CHECK(bench.refusal(Restrict{RestrictionKind::ban, key_of(1), 0, ""}, 2, two) ==
        "the player is an operator by the server's settings");
}

TEST_CASE("a frozen player stays and edits nothing", "[world][rights]") {
  RightsBench bench;
  bench.join(1, 1);
  bench.change(Restrict{RestrictionKind::freeze, key_of(1), 0, "stop it"});
  bench.edit(1, 1, kAtOrigin);
  bench.tick();
  REQUIRE(bench.rejects(1).size() == 1);
  CHECK(bench.rejects(1)[0].detail == "you may not edit: stop it");
  CHECK(bench.environment.closed.empty());
}

TEST_CASE("a full log refuses a change of rights, and nothing is half done", "[world][rights]") {
  RightsBench bench;
  bench.environment.log_room = false;
  const auto refused =
      bench.server.changes().change_rights(Protect{spawn_box()}, kConsole, 0, bench.now());
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().find("try again later") != std::string::npos);
  CHECK(bench.server.rights().state().boxes().empty());
  bench.environment.log_room = true;
  bench.tick();
  CHECK(bench.environment.records.empty());
}

TEST_CASE("a world of invited players admits who brings a valid invite", "[world][rights]") {
  RightsBench bench;
  bench.change(SetDefaultRole{kNobodyRole});
  const InviteId id = bench.server.people().new_invite_id();
  bench.change(CreateInvite{{id, kBuilderRole, 1, bench.now().utc_us + 60'000'000}});
  const std::string link = bench.server.people().invite_link(id);
  REQUIRE(link.starts_with("runstone://HOST/#"));
  const std::string token = link.substr(link.find('#') + 1);

  bench.knock(1, 1, "");
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::not_admitted);
  CHECK(bench.environment.closed[0].text == "only invited players may join: your role is nobody");
  bench.knock(2, 1, std::string(96, 'A'));
  CHECK(bench.environment.closed.back().text ==
        "only invited players may join: your role is nobody (the invite is not one of this world)");
  bench.tick();
  CHECK(bench.server.order().players().author_of(key_of(1)) ==
        std::nullopt);  // a refused player leaves nothing

  bench.knock(3, 1, token);
  REQUIRE(bench.environment.messages<SessionAccepted>(3, kEdge).size() == 1);
  const EditRecord& record = bench.environment.records.back();
  CHECK(record.op.author == bench.environment.messages<SessionAccepted>(3, kEdge)[0].author);
  CHECK(*rights_change_of(record.edit) == RightsChange(AcceptInvite{id, key_of(1)}));
  CHECK(bench.environment.players.back().key == key_of(1));

  bench.knock(4, 2, token);  // it had one use
  CHECK(bench.environment.messages<SessionAccepted>(4, kEdge).empty());
  CHECK(bench.environment.closed.back().text.find("used as often as it may be") !=
        std::string::npos);
  bench.server.disconnected(3);
  bench.knock(5, 1, token);  // the player has a role now, and needs no invite
  CHECK(bench.environment.messages<SessionAccepted>(5, kEdge).size() == 1);
}

TEST_CASE("an accepted invite whose role may not see any more closes the session",
          "[world][rights]") {
  RightsBench bench;
  bench.change(DefineRole{{"guest", {Right::see}, 0, 0, 0}});
  const InviteId id = bench.server.people().new_invite_id();
  bench.change(CreateInvite{{id, "guest", 1, bench.now().utc_us + 60'000'000}});
  bench.change(DefineRole{{"guest", {}, 0, 0, 0}});
  bench.knock(1, 1, bench.token_of(id));
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::not_admitted);
  CHECK(bench.environment.messages<SessionAccepted>(1, kEdge).empty());
  bench.tick();
}

TEST_CASE("a change of rights lets players in their handshake go on", "[world][rights]") {
  RightsBench bench;
  bench.change(SetDefaultRole{kNobodyRole});
  const InviteId id = bench.server.people().new_invite_id();
  bench.change(CreateInvite{{id, kBuilderRole, 2, bench.now().utc_us + 60'000'000}});
  bench.server.connected(1, bench.now());
  const Hello hello = bench.hello(1);
  bench.server.received(1, hello, bench.now());
  bench.knock(2, 2, bench.token_of(id));  // another player accepts it meanwhile
  CHECK(bench.environment.closed.empty());
  ClientAuth auth = bench.client_auth(1, hello, bench.environment.messages<Welcome>(1, 0).at(0));
  auth.ticket = bench.token_of(id);
  bench.server.received(1, auth, bench.now());
  CHECK(bench.environment.messages<SessionAccepted>(1, kEdge).size() == 1);
}

TEST_CASE("a ban of addresses lets administrators in, and a moderator bans no peer with it",
          "[world][rights]") {
  RightsBench bench;
  bench.change(GrantRole{key_of(1), kAdministratorRole});
  bench.change(GrantRole{key_of(2), kModeratorRole});
  bench.change(GrantRole{key_of(3), kModeratorRole});
  const AuthorId two = bench.join(2, 2, 1, kElsewhere).author;
  bench.join(3, 3, 1, kHome);
  const Restrict home{RestrictionKind::ban, AddressRange{kHome, 64}, 0, ""};
  CHECK(bench.refusal(home, 2, two).find("player3") != std::string::npos);
  bench.server.disconnected(3);
  CHECK(bench.refusal(home, 2, two).empty());
  bench.join(1, 1, 1, kHome);
  bench.server.connected(4, bench.now(), kHome);
  bench.server.received(4, bench.hello(4), bench.now());
  CHECK(bench.environment.closed.back().session == 4);
}

TEST_CASE("edits that wait are ordered before a change that forbids them", "[world][rights]") {
  RightsBench bench;
  bench.join(1, 1);
  bench.view(1, kSmall);
  bench.edit(1, 1, SetVoxel{{2, 2, 2}});
  bench.change(Restrict{RestrictionKind::freeze, key_of(1), 0, ""});
  REQUIRE(bench.environment.records.size() == 2);
  CHECK(bench.environment.records[0].cause == Cause::player);
  CHECK(bench.environment.records[1].cause == Cause::rights);
}

TEST_CASE("an invite is not used up while the log is full", "[world][rights]") {
  RightsBench bench;
  bench.change(SetDefaultRole{kNobodyRole});
  const InviteId id = bench.server.people().new_invite_id();
  bench.change(CreateInvite{{id, kBuilderRole, 1, bench.now().utc_us + 60'000'000}});
  const std::string link = bench.server.people().invite_link(id);
  const std::string token = link.substr(link.find('#') + 1);
  bench.environment.log_room = false;
  bench.knock(1, 1, token);
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].text.find("try again later") != std::string::npos);
  CHECK(bench.server.rights().state().invites().at(id).value.accepted == 0);
  bench.environment.log_room = true;
  bench.knock(2, 1, token);
  CHECK(bench.environment.messages<SessionAccepted>(2, kEdge).size() == 1);
}

}  // namespace
}  // namespace runstone::test
