// The password of a world on the world strand.
#include <catch2/catch.hpp>

#include "protocol/codec/password_key.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {
namespace {

constexpr AddressBlock kClassroom = address_block_v4(0x0a000001),
                       kAbroad = address_block_v4(0x0b000001);
const ChannelBinding kBinding{5};
const PasswordKey kRight{1, 2, 3}, kWrong{1, 2, 4};

PublicKey password_player(std::uint8_t who) { return key_pair_of(seed_of(who)).public_key; }

struct PasswordBench : WorldBench {
  PasswordBench() {
    change(SetDefaultRole{kNobodyRole});
    change(SetPassword{{{kBuilderRole, {9}, hash_of(kRight)}}});
  }
  void change(const RightsChange& change) {
    const auto done = server.changes().change_rights(change, {}, 0, now());
    INFO((done ? std::string() : done.error()));
    REQUIRE(done.has_value());
  }
  Welcome greet(SessionId session, std::uint8_t who, AddressBlock from = kClassroom,
                const std::optional<ChannelBinding>& binding = kBinding) {
    server.connected(session, now(), from, binding);
    server.received(session, hello(who), now());
    const auto welcome = environment.messages<Welcome>(session, 0);
    REQUIRE(welcome.size() == 1);
    return welcome[0];
  }
  /// Brings a password. Returns the text of the goodbye, or "" if the session is open.
  std::string bring(SessionId session, std::uint8_t who, const PasswordKey& key,
                    AddressBlock from = kClassroom, const std::string& ticket = "") {
    const Welcome welcome = greet(session, who, from);
    ClientAuth auth = client_auth(who, hello(who), welcome, kBinding);
    auth.password_key = key;
    auth.ticket = ticket;
    server.received(session, auth, now());
    return end_of(session);
  }
  std::string end_of(SessionId session) const {
    if (!environment.messages<SessionAccepted>(session, kEdge).empty()) return "";
    REQUIRE_FALSE(environment.closed.empty());
    REQUIRE(environment.closed.back().session == session);
    CHECK(environment.closed.back().reason == GoodbyeReason::not_admitted);
    return environment.closed.back().text;
  }
};

constexpr const char* kRefused = "only invited players may join: your role is nobody";

TEST_CASE("who brings the password joins, and has its role from then on", "[world][rights]") {
  PasswordBench bench;
  CHECK(bench.greet(1, 1).password_salt == PasswordSalt{9});
  CHECK(bench.bring(2, 1, kRight).empty());
  const EditRecord& record = bench.environment.records.back();
  CHECK(*rights_change_of(record.edit) == RightsChange(AcceptPassword{password_player(1)}));
  CHECK(record.op.author == bench.environment.messages<SessionAccepted>(2, kEdge)[0].author);
  CHECK(bench.environment.players.back().key == password_player(1));
  const std::size_t records = bench.environment.records.size();
  bench.server.disconnected(2);
  CHECK(bench.bring(3, 1, kWrong).empty());  // the player has a role, so the password is not read
  CHECK(bench.environment.records.size() == records);
}

TEST_CASE("a wrong password is refused, counted, and leaves nothing", "[world][rights]") {
  PasswordBench bench;
  const std::size_t records = bench.environment.records.size();
  CHECK(bench.bring(1, 1, kWrong) == std::string(kRefused) + " (the password is wrong)");
  REQUIRE(bench.server.rights().refusals().size() == 1);
  CHECK(bench.server.rights().refusals()[0].what.find("the password is wrong") !=
        std::string::npos);
  bench.tick();
  CHECK(bench.environment.records.size() == records);
  CHECK_FALSE(bench.server.order().players().author_of(password_player(1)).has_value());
}

TEST_CASE("a changed or cleared password does not help any more", "[world][rights]") {
  PasswordBench bench;
  CHECK(bench.bring(1, 1, kRight).empty());
  bench.change(SetPassword{{{kVisitorRole, {8}, hash_of(kWrong)}}});
  CHECK(bench.greet(2, 2).password_salt == PasswordSalt{8});
  CHECK_FALSE(bench.bring(3, 3, kRight).empty());
  CHECK(bench.bring(4, 4, kWrong).empty());
  CHECK(bench.server.rights().state().role_of(password_player(4)).name == kVisitorRole);
  bench.change(SetPassword{});
  CHECK_FALSE(bench.greet(5, 5).password_salt.has_value());
  CHECK(bench.bring(6, 6, kWrong) == std::string(kRefused) + " (the world has no password)");
  bench.server.disconnected(1);
  CHECK(bench.bring(7, 1, kWrong).empty());  // a role once given stays
}

TEST_CASE("a password is neither offered nor taken on a connection without encryption",
          "[world][rights]") {
  PasswordBench bench;
  const Welcome welcome = bench.greet(1, 1, kClassroom, std::nullopt);
  CHECK_FALSE(welcome.password_salt.has_value());
  ClientAuth auth = bench.client_auth(1, bench.hello(1), welcome);
  auth.password_key = kRight;
  bench.server.received(1, auth, bench.now());
  CHECK(bench.end_of(1).find("a password needs an encrypted connection") != std::string::npos);
}

TEST_CASE("an address has few wrong passwords, and right ones cost nothing", "[world][rights]") {
  PasswordBench bench;
  std::uint8_t who = 1;
  SessionId session = 1;
  for (int i = 0; i < 30; ++i) REQUIRE(bench.bring(session++, who++, kRight).empty());
  for (int i = 0; i < 10; ++i)
    REQUIRE(bench.bring(session++, who++, kWrong).find("(the password is wrong)") !=
            std::string::npos);
  const std::string limited = bench.bring(session++, who++, kWrong);
  CHECK(limited.find("wait a minute") != std::string::npos);
  CHECK(bench.bring(session++, who, kRight) == limited);  // it is not compared any more
  CHECK(bench.bring(session++, 150, kRight, kAbroad).empty());
  bench.time_us += 60'000'000;
  CHECK(bench.bring(session++, who, kRight).empty());
}

TEST_CASE("a ticket goes first, and the password helps if it does not", "[world][rights]") {
  PasswordBench bench;
  bench.change(CreateInvite{{1, kVisitorRole, 1, bench.now().utc_us + 60'000'000}});
  const std::string link = bench.server.people().invite_link(1);
  const std::string token = link.substr(link.find('#') + 1);
  CHECK(bench.bring(1, 1, kWrong, kClassroom, token).empty());
  CHECK(bench.server.rights().state().role_of(password_player(1)).name == kVisitorRole);
  CHECK(bench.bring(2, 2, kRight, kClassroom, token).empty());
  CHECK(bench.server.rights().state().role_of(password_player(2)).name == kBuilderRole);
  CHECK(bench.bring(3, 3, kWrong, kClassroom, token) ==
        std::string(kRefused) +
            " (The invite was used as often as it may be; the password is wrong)");
}

TEST_CASE("in an open world a wrong password joins with the default role and is noted",
          "[world][rights]") {
  PasswordBench bench;
  bench.change(SetDefaultRole{kVisitorRole});
  CHECK(bench.bring(1, 1, kWrong).empty());
  CHECK(bench.server.rights().state().role_of(password_player(1)).name == kVisitorRole);
  REQUIRE(bench.server.rights().refusals().size() == 1);
  CHECK(bench.server.rights().refusals()[0].what == "role: the password is wrong");
}

TEST_CASE("a banned player and a full log make no grant of the password", "[world][rights]") {
  PasswordBench bench;
  bench.change(Restrict{RestrictionKind::ban, password_player(1), 0, ""});
  CHECK(bench.bring(1, 1, kRight) == "you are banned");  // and nothing about the password
  bench.environment.log_room = false;
  CHECK(bench.bring(2, 2, kRight).find("try again later") != std::string::npos);
  bench.environment.log_room = true;
  CHECK(bench.bring(3, 2, kRight).empty());
  CHECK(bench.server.rights().state().grants().size() == 1);
}

}  // namespace
}  // namespace runstone::test
