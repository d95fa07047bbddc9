#include "server/world/people/names.hpp"

#include <catch2/catch.hpp>

#include "common/names/folded_name.hpp"
#include "protocol/codec/key_fingerprint.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone {
namespace {

using namespace test;

PublicKey public_key_of(std::uint8_t who) { return key_pair_of(seed_of(who)).public_key; }

NameClaim claim_of(const std::string& name, std::uint8_t who) {
  return {folded_name(name), name, public_key_of(who)};
}

/// Players whose clients keep their keys.
struct NameBench : WorldBench {
  using WorldBench::WorldBench;

  /// Does the handshake. Returns true if the session was accepted at once.
  bool enters(SessionId session, std::uint8_t who, const std::string& name, AddressBlock from = {},
              std::uint64_t features = kFeatureNames) {
    server.connected(session, now(), from);
    Hello h = hello(who, session);
    h.name = name;
    h.features = features;
    server.received(session, h, now());
    const auto welcome = environment.messages<Welcome>(session, 0);
    if (welcome.empty()) return false;
    server.received(session, client_auth(who, h, welcome[0]), now());
    return is_accepted(session);
  }
  bool is_accepted(SessionId session) const {
    return !environment.messages<SessionAccepted>(session, kEdge).empty();
  }
  /// Reports that all changes of names are on disk.
  void write_names() {
    server.names_durable(environment.names.size() - written, now());
    written = environment.names.size();
  }
  /// Returns the text of the refusal of a session, or an empty text.
  std::string refusal(SessionId session) const {
    for (const auto& closed : environment.closed) {
      if (closed.session == session && closed.reason == GoodbyeReason::name_refused)
        return closed.text;
    }
    return "";
  }
  std::size_t written = 0;
};

TEST_CASE("a session is accepted when the claim of its name is on disk", "[world][names]") {
  NameBench bench;
  CHECK_FALSE(bench.enters(1, 1, "Ana"));
  REQUIRE(bench.environment.names.size() == 1);
  CHECK(bench.environment.names[0].claim == claim_of("Ana", 1));
  CHECK_FALSE(bench.environment.names[0].is_release);
  SECTION("nothing is sent before") {
    bench.tick();
    CHECK_FALSE(bench.is_accepted(1));
    bench.write_names();
    CHECK(bench.is_accepted(1));
    CHECK(bench.enters(2, 1, "ANA"));  // it owns the name
    CHECK(bench.environment.names.size() == 1);
  }
  SECTION("another key is refused from the first moment on") {
    CHECK_FALSE(bench.enters(2, 2, "ana"));
    CHECK(bench.refusal(2) == "the name \"ana\" belongs to the player with the key " +
                                  key_fingerprint(public_key_of(1)) +
                                  ": choose another name, or ask the server's host to release it");
    CHECK(bench.environment.names.size() == 1);
    CHECK(bench.environment.messages<Welcome>(2, 0).empty());  // no signature was made
  }
  SECTION("another session of the key waits too") {
    CHECK_FALSE(bench.enters(2, 1, "ana"));
    CHECK(bench.environment.names.size() == 1);
    bench.write_names();
    CHECK(bench.is_accepted(1));
    CHECK(bench.is_accepted(2));
  }
  SECTION("nobody waits for a full disk") {
    bench.server.set_disk_is_full(true, bench.now());
    CHECK(bench.is_accepted(1));
    CHECK(bench.enters(2, 1, "Ana"));
  }
  SECTION("client auth twice is an error") {
    bench.server.received(1, ClientAuth{}, bench.now());
    REQUIRE(bench.environment.closed.size() == 1);
    CHECK(bench.environment.closed[0].reason == GoodbyeReason::unexpected_message);
  }
  SECTION("a client that leaves meanwhile keeps its claim") {
    bench.server.disconnected(1);
    bench.write_names();
    CHECK_FALSE(bench.is_accepted(1));
    CHECK_FALSE(bench.enters(2, 2, "ana"));
  }
}

TEST_CASE("a claim of the store counts at the start", "[world][names]") {
  WorldStart start;
  start.name_claims = {claim_of("Ana", 7)};
  NameBench bench(config(), start);
  CHECK(bench.enters(1, 7, "ana"));
  CHECK_FALSE(bench.enters(2, 1, "\uff21na"));
  CHECK_FALSE(bench.refusal(2).empty());
}

TEST_CASE("a client that does not keep its key owns nothing and takes nothing", "[world][names]") {
  NameBench bench;
  CHECK(bench.enters(1, 1, "ana", {}, 0));
  CHECK(bench.enters(2, 2, "ana", {}, 0));
  CHECK(bench.environment.names.empty());
  CHECK_FALSE(bench.enters(3, 3, "ana"));  // the first who keeps a key owns the name
  bench.write_names();
  CHECK(bench.is_accepted(3));
  CHECK_FALSE(bench.enters(4, 2, "ana", {}, 0));
  CHECK_FALSE(bench.refusal(4).empty());
}

TEST_CASE("a wrong signature claims nothing", "[world][names]") {
  NameBench bench;
  bench.server.connected(1, bench.now());
  Hello h = bench.hello(1);
  h.features = kFeatureNames;
  bench.server.received(1, h, bench.now());
  bench.server.received(1, ClientAuth{}, bench.now());
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.names.empty());
  CHECK(bench.server.order().names().all().empty());
}

TEST_CASE("a key owns a few names and is told which", "[world][names]") {
  WorldConfig c = config();
  c.names_per_key = 2;
  NameBench bench(c);
  bench.enters(1, 1, "one");
  bench.enters(2, 1, "two");
  bench.write_names();
  CHECK_FALSE(bench.enters(3, 1, "three"));
  CHECK(bench.refusal(3) ==
        "your key owns 2 names and no more are allowed: choose one of them, or ask the server's "
        "host to release one: \"one\", \"two\"");
  CHECK(bench.enters(4, 1, "One"));
  REQUIRE(bench.server.people().names().release("TWO").has_value());
  CHECK(bench.environment.names.back().is_release);
  CHECK_FALSE(bench.enters(5, 1, "three"));
  bench.write_names();
  CHECK(bench.is_accepted(5));
  CHECK_FALSE(bench.server.people().names().release("two").has_value());
}

TEST_CASE("reserved names and names with a fault are refused", "[world][names]") {
  WorldConfig c = config();
  c.reserved_names = {"server"};
  NameBench bench(c);
  SessionId session = 0;
  for (const char* name : {"server", "SERVER", "\uff53\uff45\uff52\uff56\uff45\uff52",
                           "\u24e2\u24d4\u24e1\u24e5\u24d4\u24e1"}) {
    CAPTURE(name);
    CHECK_FALSE(bench.enters(++session, 1, name));
    CHECK(bench.refusal(session).find("is reserved") != std::string::npos);
  }
  CHECK_FALSE(bench.enters(++session, 1, "\u0430na"));
  CHECK(bench.refusal(session).find("Cyrillic") != std::string::npos);
  CHECK(bench.environment.names.empty());
}

TEST_CASE("nobody newly gets a name that looks reserved, like a role, or like a reference",
          "[world][names]") {
  WorldConfig c = config();
  c.reserved_names = {"admin", "me", "op", "server"};
  NameBench bench(c);
  const auto change = [&](const RightsChange& what) {
    REQUIRE(bench.server.changes().change_rights(what, {}, 0, bench.now()).has_value());
  };
  change(DefineRole{{"captain", {Right::see, Right::moderate}, 0, 0, 0}});
  SessionId session = 0;
  const auto refused = [&](const std::string& name) {
    CAPTURE(name);
    CHECK_FALSE(bench.enters(++session, 1, name));
    return bench.refusal(session);
  };
  CHECK(refused("adm\u0131n") ==
        "the name \"adm\u0131n\" looks like \"admin\", which is reserved: choose another name");
  CHECK(refused("[ADMIN] ana").find("looks like \"admin\"") != std::string::npos);
  CHECK(refused("\u13daerver").find("looks like \"server\"") != std::string::npos);
  CHECK(refused("[OP] ana").find("looks like \"op\"") != std::string::npos);
  CHECK(refused("ana (op)").find("looks like \"op\"") != std::string::npos);
  CHECK(refused("Captain Ana").find("looks like \"captain\", a role") != std::string::npos);
  CHECK(refused("moderat0r").find("looks like \"moderator\", a role") != std::string::npos);
  CHECK(
      refused("#1") ==
      "the name \"#1\" is refused: commands read it as the number of a player: choose another name");
  CHECK(refused("\uff03"
                "1")
            .find("the number of a player") != std::string::npos);
  CHECK(refused("192.0.2.7").find("an address") != std::string::npos);
  CHECK(refused("role:builder").find("commands read it as a role") != std::string::npos);
  CHECK(refused("Role\uff1amason").find("commands read it as a role") != std::string::npos);
  CHECK(refused("an*").find("commands read it as a pattern of names") != std::string::npos);
  CHECK(refused(key_fingerprint(public_key_of(2))).find("a key") != std::string::npos);
  CHECK(bench.environment.names.empty());

  change(RemoveRole{"captain"});
  CHECK_FALSE(bench.enters(++session, 3, "Captain Ana"));  // its claim is on its way to the disk
  bench.write_names();
  CHECK(bench.is_accepted(session));
  change(DefineRole{{"captain", {Right::see, Right::moderate}, 0, 0, 0}});
  CHECK(bench.enters(++session, 3, "Captain Ana"));  // the owner keeps the name
  CHECK_FALSE(bench.enters(++session, 4, "Captain Bob"));
  // A fingerprint means its own player whether or not it is a name too.
  CHECK_FALSE(bench.enters(++session, 7, key_fingerprint(public_key_of(7))));
  CHECK(bench.refusal(session).empty());
  CHECK_FALSE(bench.enters(++session, 6, "Call me Ana"));
  CHECK(bench.refusal(session).empty());
}

TEST_CASE("the names of all roles are guarded but that of the default role", "[world][names]") {
  NameBench bench;
  const auto change = [&](const RightsChange& what) {
    REQUIRE(bench.server.changes().change_rights(what, {}, 0, bench.now()).has_value());
  };
  SessionId session = 0;
  // The clients keep no key, so nobody claims a name.
  const auto why = [&](const std::string& name) {
    ++session;
    bench.enters(session, static_cast<std::uint8_t>(session), name, {}, 0);
    return bench.refusal(session);
  };
  change(DefineRole{{"mason", {Right::see, Right::build}, 0, 0, 0}});
  CHECK(why("mason").find("looks like \"mason\", a role of this world") != std::string::npos);
  CHECK(why("[MASON] ana").find("looks like \"mason\"") != std::string::npos);
  CHECK(why("mas0n").find("looks like \"mason\"") != std::string::npos);
  CHECK(why("Visitor").find("looks like \"visitor\"") != std::string::npos);
  CHECK(why("masonry").empty());
  CHECK(why("Nobody Special").empty());  // "nobody" is a role, and means a listener
  // Everybody has the default role.
  CHECK(why("builder-1").empty());
  CHECK(why("Bob the Builder").empty());
  change(SetDefaultRole{"mason"});
  CHECK(why("Ana the Mason").empty());
  CHECK(why("Bob the Builder").find("looks like \"builder\"") != std::string::npos);
  // Clients call their player so at first, until the role has rights over others.
  CHECK(why("builder").empty());
  CHECK(why("Builder").empty());
  change(DefineRole{{"builder", {Right::see, Right::moderate}, 0, 0, 0}});
  CHECK(why("builder").find("looks like \"builder\"") != std::string::npos);
}

TEST_CASE("an address claims so many names an hour, and its other players play without",
          "[world][names]") {
  WorldConfig c = config();
  c.names_per_address = 2;
  NameBench bench(c);
  const AddressBlock here = address_block_v4(1), there = address_block_v4(2);
  CHECK_FALSE(bench.enters(1, 1, "one", here));
  CHECK_FALSE(bench.enters(2, 2, "two", here));
  CHECK(bench.enters(3, 3, "three", here));
  CHECK(bench.environment.names.size() == 2);
  CHECK_FALSE(bench.enters(4, 4, "four", there));
  bench.time_us += 1'800'000'000;
  CHECK_FALSE(bench.enters(5, 3, "three", here));
  CHECK(bench.environment.names.size() == 4);
}

TEST_CASE("without room in the log a player plays without owning the name", "[world][names]") {
  NameBench bench;
  bench.environment.log_room = false;
  CHECK(bench.enters(1, 1, "ana"));
  CHECK(bench.environment.names.empty());
  CHECK_FALSE(bench.server.people().names().release("ana").has_value());
  bench.environment.log_room = true;
  CHECK_FALSE(bench.enters(2, 1, "ana"));  // the next join claims it
  bench.write_names();
  CHECK(bench.is_accepted(2));
}

TEST_CASE("a session without a seat claims nothing", "[world][names]") {
  WorldConfig c = config();
  c.sessions_max = 1;
  NameBench bench(c);
  CHECK(bench.enters(1, 1, "ana", {}, 0));
  CHECK_FALSE(bench.enters(2, 2, "bob"));
  CHECK(bench.environment.names.empty());
}

}  // namespace
}  // namespace runstone
