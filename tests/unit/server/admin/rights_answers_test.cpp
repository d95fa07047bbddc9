// The answers of the commands about rights.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "protocol/codec/key_fingerprint.hpp"
#include "server/admin/command_table.hpp"
#include "server/admin/password_commands.hpp"
#include "tests/unit/server/admin/command_bench.hpp"

namespace runstone::test {
namespace {

constexpr SessionId kFirst = 1, kSecond = 2;  // the key of session n is that of seed n

/// A world with two players, and its commands.
struct RightsBench : CommandBench {
  explicit RightsBench(const WorldStart& start = {})
      : CommandBench(config(), start),
        services{
            bench.server, service, *this, placing, folder.path(), {}, [this](const PublicKey& key) {
              return key == operator_key;
            }} {
    join(kFirst);
    join(kSecond);
  }

  CommandAnswer give(const CommandCaller& caller, const std::string& line) {
    answers.clear();
    const Clocks now = bench.now();
    give_command({services, caller, {now.steady_us, now.utc_us - set_back_us}, reply()}, line);
    for (int i = 0; i < 3; ++i) {
      run_all();
      services.tick(now);
    }
    return answer();
  }
  CommandAnswer console(const std::string& line) { return give({}, line); }
  /// Gives a command at the console. What it orders is not on disk yet.
  void order(const std::string& line) {
    answers.clear();
    give_command({services, {}, bench.now(), reply()}, line);
  }
  CommandAnswer player(std::uint8_t who, const std::string& line) {
    const PublicKey key = key_of(who);
    return give({who, {key, key == operator_key}}, line);
  }
  /// Gives a command at the console that must succeed.
  std::string done(const std::string& line) {
    const CommandAnswer given = console(line);
    INFO(line << ": " << given.text);
    CHECK(given.is_ok);
    return given.text;
  }

  static PublicKey key_of(std::uint8_t who) { return key_pair_of(seed_of(who)).public_key; }
  /// Returns "player1 #1 9M1Q-Z7CR-04KD".
  static std::string text_of(std::uint8_t who) {
    const std::string number = std::to_string(who);
    return "player" + number + " #" + number + " " + key_fingerprint(key_of(who));
  }
  std::string role_of(std::uint8_t who) {
    return bench.server.rights().state().role_of(key_of(who)).name;
  }
  /// Lets a key join once more, under a name that it owns.
  void join_as(SessionId session, std::uint8_t who, const std::string& name) {
    Hello hello = bench.hello(who, session);
    hello.name = name;
    bench.server.connected(session, bench.now());
    bench.server.received(session, hello, bench.now());
    const auto welcome = bench.environment.messages<Welcome>(session, 0);
    REQUIRE(welcome.size() == 1);
    bench.server.received(session, bench.client_auth(who, hello, welcome[0]), bench.now());
  }
  Sequence head() { return bench.server.order().head(); }
  static std::string record(Sequence seq) { return " (record " + std::to_string(seq) + ")"; }

  TimeUs set_back_us = 0;  // of the system's clock, after the world was started
  PublicKey operator_key{};
  CommandServices services;
};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("grants and revokes answer with the key's fingerprint and the record",
          "[admin][rights]") {
  RightsBench bench;
  CHECK(bench.done("grant player1 moderator") ==
        RightsBench::text_of(1) + " has the role moderator" + bench.record(1));
  CHECK(bench.role_of(1) == "moderator");
  CHECK(has(bench.done("grants"), RightsBench::text_of(1) + ": moderator; record "));
  CHECK(has(bench.done("roles"), "moderator: "));
  CHECK(has(bench.done("revoke #1"), RightsBench::text_of(1) + " has the default role "));
  CHECK_FALSE(bench.console("revoke #1").is_ok);
  CHECK(bench.console("grant nobody builder").text ==
        "\"nobody\": nobody of that name is known here (players and names list the others)");
  CHECK(has(bench.console("grant player1 mason").text, "mason"));
  CHECK_FALSE(bench.console("grant player1 mason").is_ok);
}

TEST_CASE("a grant for some time ends by itself, and the role before counts again",
          "[admin][rights]") {
  RightsBench bench;
  constexpr std::uint8_t kReader = 7;
  bench.bench.join(kReader, kReader, 1, {}, kFeatureChat);
  const std::string who = key_fingerprint(RightsBench::key_of(kReader));
  bench.done("grant " + who + " visitor");
  const std::string answer = bench.done("grant " + who + " moderator for 2h");
  CHECK(has(answer, " has the role moderator until "));
  CHECK(has(bench.done("grants"), ": moderator until "));
  CHECK(has(bench.done("why " + who + " moderate"), "was given the role moderator until "));
  CHECK(bench.player(kReader, "bans").is_ok);
  const auto said = [&] {
    std::vector<std::string> texts;
    for (const auto& lines : bench.bench.environment.messages<ChatLines>(kReader, kEdge)) {
      for (const ChatLine& line : lines.lines) texts.push_back(line.text);
    }
    return texts;
  };
  bench.bench.tick(7'100'000'000);
  CHECK(bench.role_of(kReader) == "moderator");
  bench.bench.join(kReader + 1, kReader, 2, {}, kFeatureChat);  // the silent session was closed
  bench.bench.tick(200'000'000);
  CHECK(bench.role_of(kReader) == "visitor");
  CHECK_FALSE(bench.player(kReader, "bans").is_ok);
  CHECK_FALSE(has(bench.done("grants"), "moderator"));
  bench.bench.tick();

  CHECK_FALSE(bench.console("grant " + who + " moderator for 0s").is_ok);
  CHECK_FALSE(bench.console("grant " + who + " moderator 2h").is_ok);
  bench.done("grant " + who + " moderator for 2h");
  bench.done("revoke " + who);
  CHECK(bench.role_of(kReader) == "builder");
  CHECK_FALSE(bench.console("revoke " + who).is_ok);
  CHECK(said().empty());
}

TEST_CASE("a player who is here is told that a role has ended", "[admin][rights]") {
  RightsBench bench;
  constexpr std::uint8_t kReader = 7;
  bench.bench.join(kReader, kReader, 1, {}, kFeatureChat | kFeatureRights);
  const std::string who = key_fingerprint(RightsBench::key_of(kReader));
  bench.done("grant " + who + " moderator for 2s");
  bench.bench.tick(1'000'000);
  const auto permissions = [&] {
    return bench.bench.environment.messages<Permissions>(kReader, kEdge).back().role;
  };
  CHECK(permissions() == "moderator");
  bench.bench.tick(2'000'000);
  CHECK(permissions() == "builder");
  const auto lines = bench.bench.environment.messages<ChatLines>(kReader, kEdge);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].lines[0].text == "your role moderator has ended: your role is builder now");
  bench.bench.tick(1'000'000);
  CHECK(bench.bench.environment.messages<ChatLines>(kReader, kEdge).size() == 1);
}

TEST_CASE("the console makes roles, and players need the right", "[admin][rights]") {
  RightsBench bench;
  CHECK(bench.done("role set mason see,build claims 2") ==
        "role mason is see,build claims 2" + bench.record(1));
  bench.done("role default mason");
  CHECK(bench.role_of(2) == "mason");
  const CommandAnswer refused = bench.player(2, "role set mason see,build,administer");
  CHECK_FALSE(refused.is_ok);
  CHECK(refused.text == "this command needs the right administer; your role is mason");
  CHECK_FALSE(bench.console("role remove mason").is_ok);  // it is the default role
  bench.done("role default builder");
  CHECK(bench.done("role remove mason") == "role mason is removed" + bench.record(4));
  CHECK(has(bench.player(2, "help").text, "claim NAME"));
  CHECK_FALSE(has(bench.player(2, "help").text, "log FILTERS"));
  CHECK(has(bench.done("help"), "reload "));
}

TEST_CASE("a number or address that is also a player's name is refused with a word for each",
          "[admin][rights][names]") {
  // Player 2 owns these names from before nobody could newly have them.
  WorldStart start;
  for (const char* name : {"#1", "192.0.2.7"})
    start.name_claims.push_back({name, name, RightsBench::key_of(2)});
  RightsBench bench(start);
  constexpr SessionId kThird = 3;
  bench.join_as(kThird, 2, "#1");
  const std::string one =
      RightsBench::text_of(1) + " (say " + key_fingerprint(RightsBench::key_of(1)) + ")";
  const std::string other = RightsBench::text_of(2) + " (say #2)";
  for (const char* line : {"mute #1", "grant #1 moderator", "log author #1", "kick \"#1\"",
                           "protect home 0 0 0 1 1 1 owner #1", "rollback preview author #1"}) {
    CAPTURE(line);
    const CommandAnswer answer = bench.console(line);
    CHECK_FALSE(answer.is_ok);
    CAPTURE(answer.text);
    CHECK(has(answer.text, "\"#1\": that is also the name of a player; it may mean "));
    CHECK(has(answer.text, one));
    CHECK(has(answer.text, other));
  }
  CHECK(bench.head() == 0);
  CHECK(bench.console("ban 192.0.2.7").text ==
        "\"192.0.2.7\" is an address and the name of 192.0.2.7 #2 " +
            key_fingerprint(RightsBench::key_of(2)) +
            ": say address 192.0.2.7, or #2 for the player");
  CHECK(bench.head() == 0);
  CHECK(has(bench.done("ban address 192.0.2.7"), "everybody from 192.0.2.7, except"));
  bench.done("unban address 192.0.2.7");
  CHECK(has(bench.done("mute #2"), " is muted"));
}

TEST_CASE("an answer about a role says that a player has the word as a name",
          "[admin][rights][names]") {
  WorldStart start;
  start.name_claims.push_back({"role:moderator", "role:moderator", RightsBench::key_of(2)});
  RightsBench bench(start);
  bench.join_as(3, 2, "role:moderator");
  bench.done("protect town 0 0 0 9 9 9");
  CHECK(bench.done("protect town add role:moderator role:visitor") ==
        "town admits: the role moderator [\"role:moderator\" is also the name of " +
            RightsBench::text_of(2) + " (say #2)], the role visitor" + bench.record(2));
}

TEST_CASE("a change with wide consequences says what it would do and asks for a word more",
          "[admin][rights]") {
  RightsBench bench;
  const auto asked = [&](const std::string& line, const std::string& why) {
    CAPTURE(line);
    const Sequence before = bench.head();
    const CommandAnswer answer = bench.console(line);
    CHECK_FALSE(answer.is_ok);
    CAPTURE(answer.text);
    CHECK(has(answer.text, why));
    CHECK(has(answer.text, "give the command as: " + line + " anyway"));
    CHECK(bench.head() == before);
  };
  asked("role default administrator", "everybody without a granted role");
  asked("role set builder see,moderate",
        "would lose the rights build,claim,look_back,undo,chat (role set names all rights of a "
        "role: role set builder see,build,claim,look_back,undo,chat,moderate keeps them)");
  asked("role set builder see", "would lose the rights");
  asked("role set builder see,chat,look_back,undo,claim,build,moderate", "would have the rights");
  asked("ban 0.0.0.0/0", "from 0.0.0.0/0, 4294967296 addresses");
  asked("ban ::/0 for 1h", "all addresses there are");
  asked("ban address 10.0.0.0/15 reason spam", "131072 addresses");
  asked("invite role administrator uses 5", "the first 5 players with the link");
  bench.done("ban 10.1.0.0/16");
  bench.done("invite role administrator");
  bench.done("role set mason see,build");
  bench.done("role set mason see,build,undo");

  const std::string world = "protect world columns -536870912 -536870912 536870911 536870911";
  asked(world,
        "world would protect columns -536870912 -536870912 to 536870911 536870911, "
        "1152921504606846976 columns of ground: nobody could build there but its owner, its "
        "members, its roles and whoever has the right build_protected, apart from boxes of a "
        "higher priority");
  asked("protect plain -8192 0 -8192 8192 0 8191", "268451840 columns of ground");
  bench.done("protect plain columns -8192 -8192 8191 8191");
  asked("protect plain columns -8192 -8192 8191 8192", "columns of ground");
  CHECK(has(bench.done(world + " anyway"), "world protects columns"));
  bench.done("protect world owner player1");
  asked("protect world priority 1", "world would protect");
  bench.done("protect world priority -1");
  // The word is also the name of an owner.
  CHECK(has(bench.console("protect world owner anyway").text, "\"anyway\": nobody of that name"));
  CHECK(has(bench.done("unprotect world"), "world protects nothing any more"));

  const JoinPassword password{"administrator", {1}, {2}};
  const std::string verifier = verifier_text(password);
  const CommandAnswer secret =
      bench.console("password set role administrator verifier " + verifier);
  CHECK(has(secret.text, "whoever knows the password would have the rights"));
  CHECK_FALSE(has(secret.text, verifier));

  CHECK(has(bench.done("role default administrator anyway"), "have the role administrator"));
  CHECK(has(bench.done("ban 192.0.2.0/24"),
            "everybody from 192.0.2.0/24, except administrators, is banned; players without a "
            "granted role still join, because the default role administrator administers"));
  bench.done("grant player1 administrator");  // the world must keep one
  bench.done("role default builder");
  asked("rights undo " + std::to_string(bench.head()), "everybody without a granted role");
  CHECK(has(bench.done("role set builder see anyway"), "role builder is see"));
  bench.done("ban 0.0.0.0/0 for 1h reason \"all of them\" anyway");
  // The word is also a name, and the text of a reason.
  CHECK(has(bench.console("ban anyway").text, "nobody of that name"));
  bench.done("ban 198.51.100.1 reason anyway");
  CHECK(has(bench.done("bans"), "\"anyway\""));
}

TEST_CASE("control sets a password that the console and players cannot type", "[admin][rights]") {
  RightsBench bench;
  CHECK(has(bench.console("password set").text, "runstone-server control"));
  CHECK(bench.head() == 0);
  const JoinPassword password{"visitor", {1}, {2}};
  const std::string line = "password set role visitor verifier " + verifier_text(password);
  bench.done("grant player1 administrator");
  CHECK_FALSE(bench.player(1, line).is_ok);
  CHECK(bench.done(line) ==
        "players without a granted role join with the password and get the role visitor; others "
        "still join as builder (role default nobody keeps them out)" +
            bench.record(2));
  CHECK(bench.bench.server.rights().state().password().value == password);
  bench.done("role default nobody");
  CHECK(bench.done(line) ==
        "players without a granted role join with the password and get the role visitor" +
            bench.record(4));
  CHECK(has(bench.done("password"), "gets the role visitor; record 4, "));
  CHECK(has(bench.player(1, "password clear").text, "the world has no password"));
  CHECK_FALSE(bench.bench.server.rights().state().password().value.has_value());
  CHECK(bench.console("password clear").text == "The world has no password.");
}

TEST_CASE("a ban holds after the system's clock was set back", "[admin][rights]") {
  RightsBench bench;
  bench.tick();  // the time of the log begins
  bench.set_back_us = 86'400'000'000;
  bench.done("ban player1 for 1h");
  CHECK(bench.bench.server.session_count() == 1);
  CHECK(has(bench.done("bans"), RightsBench::text_of(1)));
}

TEST_CASE("a ban ends sessions and is listed until it is lifted", "[admin][rights]") {
  RightsBench bench;
  const std::string text = bench.done("ban player1 for 1d reason \"broke the bridge\"");
  CHECK(has(text, RightsBench::text_of(1) + " is banned until "));
  CHECK(has(text, ": broke the bridge (record "));
  CHECK(has(text, "; sessions ended: 1"));
  CHECK(bench.bench.server.session_count() == 1);
  CHECK(has(bench.done("bans"), "\"broke the bridge\""));
  CHECK(bench.done("unban player1") ==
        RightsBench::text_of(1) + " is no longer banned" + bench.record(2));
  CHECK(bench.console("unban player1").text ==
        RightsBench::text_of(1) + " is not banned (bans lists all)");
  CHECK(bench.done("bans") == "nobody is banned, muted or frozen");

  CHECK(has(bench.done("ban 2001:db8::1"),
            "everybody from 2001:db8::/64, except administrators, is banned [a single IPv6 "
            "address means its /64]"));
  bench.done("ban 192.0.2.0/24");
  CHECK(bench.console("unban 192.0.2.7").text ==
        "everybody from 192.0.2.7 is not banned, but 192.0.2.0/24 is (bans lists all)");
  bench.done("unban 192.0.2.0/24");
  bench.done("mute player2 reason spam");
  bench.done("unmute player2");
  bench.done("freeze player2");
  CHECK(bench.player(2, "undo").text == "you are frozen");
}

TEST_CASE("a ban of several players has a line for each, in one answer", "[admin][rights]") {
  RightsBench bench;
  const std::string both = bench.done("ban player2 player1 #2 for 1d reason spam");
  CHECK(both.starts_with(RightsBench::text_of(2) + " is banned until "));
  CHECK(
      has(both, ": spam (record 1); sessions ended: 1\n" + RightsBench::text_of(1) + " is banned"));
  CHECK(std::ranges::count(both, '\n') == 1);
  CHECK(bench.answers.size() == 1);
  CHECK(bench.bench.server.session_count() == 0);

  const CommandAnswer one = bench.console("unmute player1 player2");
  CHECK_FALSE(one.is_ok);
  bench.done("mute player2");
  const CommandAnswer mixed = bench.console("unmute player1 player2");
  CHECK_FALSE(mixed.is_ok);
  CHECK(mixed.text == RightsBench::text_of(1) + " is not muted (bans lists all)\n" +
                          RightsBench::text_of(2) + " is no longer muted" +
                          bench.record(bench.head()));
}

TEST_CASE("a ban of several players with one who is unknown changes nothing", "[admin][rights]") {
  RightsBench bench;
  const CommandAnswer refused = bench.console("ban player1 nobody");
  CHECK_FALSE(refused.is_ok);
  CHECK(refused.text.starts_with("nothing has changed: \"nobody\": nobody of that name"));
  const CommandAnswer wide = bench.console("ban player1 0.0.0.0/0");
  CHECK_FALSE(wide.is_ok);
  CHECK(has(wide.text, "nothing has changed: nobody but administrators could join from"));
  CHECK(has(wide.text, "give the command as: ban player1 0.0.0.0/0 anyway"));
  CHECK(bench.head() == 0);
  CHECK(bench.bench.server.session_count() == 2);
  bench.done("ban player1 0.0.0.0/0 anyway");
  CHECK(bench.head() == 2);
}

TEST_CASE("several players are kicked in one line, and each who is not here is named",
          "[admin][rights]") {
  RightsBench bench;
  bench.done("kick player2");
  const CommandAnswer kicked = bench.console("kick player1 player2 reason bye");
  CHECK_FALSE(kicked.is_ok);
  CHECK(kicked.text == RightsBench::text_of(1) + " was kicked; sessions ended: 1\n" +
                           RightsBench::text_of(2) + " is not here");
}

TEST_CASE("a player kicks only players with fewer rights", "[admin][rights]") {
  RightsBench bench;
  bench.done("grant player1 moderator");
  bench.done("grant player2 administrator");
  bench.done("grant " + std::string(64, 'a') + " administrator");  // somebody must stay one
  CHECK_FALSE(bench.player(1, "kick player2").is_ok);
  CHECK_FALSE(bench.player(1, "ban player2").is_ok);
  bench.done("grant player2 builder");
  CHECK(bench.player(1, "kick player2 reason \"have a walk\"").text ==
        RightsBench::text_of(2) + " was kicked; sessions ended: 1");
  CHECK(has(bench.console("kick player2").text, " is not here"));
}

TEST_CASE("boxes are protected, shared and removed by command", "[admin][rights]") {
  RightsBench bench;
  bench.done("grant player1 builder");
  bench.done("grant player2 builder");
  CHECK(bench.done("protect town 0 0 0 9 9 9 priority 3") ==
        "town protects 0 0 0 to 9 9 9, priority 3, owner nobody" + bench.record(3));
  CHECK(bench.done("protect town owner player1") ==
        "town protects 0 0 0 to 9 9 9, priority 3, owner " + RightsBench::text_of(1) +
            bench.record(4));
  CHECK(bench.player(1, "protect town add player2 role:moderator").text ==
        "town admits: " + RightsBench::text_of(2) + ", the role moderator" + bench.record(5));
  CHECK_FALSE(bench.player(1, "protect town add player2").is_ok);
  CHECK(has(bench.done("protected at 9 9 9"), ", members " + RightsBench::text_of(2)));
  CHECK(bench.done("protected at 10 9 9") == "no box protects 10 9 9");
  CHECK_FALSE(bench.player(2, "unprotect town").is_ok);
  CHECK(bench.player(1, "protect town remove player2").is_ok);
  CHECK(bench.player(1, "unprotect town").is_ok);
  CHECK(has(bench.console("unprotect town").text, "there is no protected box \"town\""));
  CHECK(has(bench.console("protect town priority 1").text, "there is no protected box \"town\""));

  CHECK(bench.player(2, "claim home 20 0 0 29 9 9").text ==
        "home protects 20 0 0 to 29 9 9 for you" + bench.record(8));
  CHECK(has(bench.player(1, "claim home 40 0 0 49 9 9").text, "of somebody else"));
  CHECK_FALSE(bench.player(1, "claim hut 25 0 0 35 9 9").is_ok);
  CHECK(has(bench.console("claim hut 25 0 0 35 9 9").text, "claims are for players"));
  CHECK(bench.done("protect strip columns 100 100 120 120") ==
        "strip protects columns 100 100 to 120 120, priority 0, owner nobody" + bench.record(9));
}

TEST_CASE("why answers everybody about themselves and moderators about others", "[admin][rights]") {
  RightsBench bench;
  bench.done("grant player2 builder");
  CHECK(bench.player(2, "why player2 build").is_ok);
  const CommandAnswer refused = bench.player(2, "why player1 build");
  CHECK_FALSE(refused.is_ok);
  CHECK(refused.text ==
        "about other players: this command needs the right moderate; your role is builder");
  CHECK(has(bench.done("why player2 build 1 2 3"), "yes: " + RightsBench::text_of(2)));
  bench.operator_key = RightsBench::key_of(2);
  CHECK(has(bench.done("why player2 administer"), "`operators` names the key"));
  CHECK(bench.player(2, "why player1 build").is_ok);
}

TEST_CASE("a record about rights is listed and taken back", "[admin][rights]") {
  RightsBench bench;
  bench.done("grant player1 builder");
  const std::string first = std::to_string(bench.head());
  bench.done("grant player1 moderator");
  const std::string second = std::to_string(bench.head());
  const std::string shown = key_fingerprint(RightsBench::key_of(1));
  CHECK(has(bench.done("log cause rights"), " rights gave " + shown + " the role moderator"));
  CHECK(has(bench.console("rights undo " + first).text, "decides nothing any more"));
  CHECK(bench.done("rights undo " + second) == "record " + second + " (gave " + shown +
                                                   " the role moderator) is taken back: gave " +
                                                   shown + " the role builder" + bench.record(3));
  CHECK(bench.role_of(1) == "builder");
  CHECK(has(bench.console("rights undo 99").text, "record 99 changes no rights"));
}

TEST_CASE("taking a record back waits until later ones are on disk", "[admin][rights]") {
  RightsBench bench;
  const Clocks now = bench.bench.now();
  const std::string key(64, 'a');
  bench.done("grant " + key + " builder");
  const std::string first = std::to_string(bench.head());
  bench.done("role set mason see");
  give_command({bench.services, {}, now, bench.reply()},
               "role set mason see,build");  // not on disk yet
  REQUIRE(bench.bench.server.order().durable() < bench.head());
  bench.answers.clear();
  give_command({bench.services, {}, now, bench.reply()}, "rights undo " + first);
  CHECK(bench.works.empty());
  CHECK(bench.answers.empty());
  bench.run_all();
  bench.services.tick(now);
  bench.run_all();
  CHECK(bench.answer().is_ok);
  CHECK(bench.bench.server.rights().state().grants().empty());
}

TEST_CASE("a change of rights is in force at once, and answered when it is on disk",
          "[admin][rights]") {
  RightsBench bench;
  WorldServer& world = bench.bench.server;
  const Clocks now = bench.bench.now();
  const Clocks late{now.steady_us + kAnswerUnsavedUs, now.utc_us};
  bench.order("role set mason see");
  CHECK(world.rights().state().find_role("mason") != nullptr);
  bench.services.tick(now);
  CHECK(bench.answers.empty());
  SECTION("on disk in time") {
    bench.run_all();
    bench.services.tick(now);
    REQUIRE(bench.answers.size() == 1);
    CHECK(bench.answers[0].is_done);
    CHECK(bench.answers[0].is_ok);
  }
  SECTION("late") {
    bench.services.tick(late);
    bench.services.tick(late);
    REQUIRE(bench.answers.size() == 1);
    CHECK(bench.answers[0].is_unsaved);
    CHECK_FALSE(bench.answers[0].is_done);
    CHECK(has(bench.answers[0].text, "in force, not on disk yet"));
    bench.run_all();
    bench.services.tick(late);
    REQUIRE(bench.answers.size() == 2);
    CHECK(bench.answers[1].is_done);
    CHECK(bench.answers[1].is_ok);
  }
  SECTION("never") {
    world.log_failed();
    bench.services.tick(now);
    REQUIRE(bench.answers.size() == 1);
    CHECK(bench.answers[0].is_done);
    CHECK_FALSE(bench.answers[0].is_ok);
    CHECK(has(bench.answers[0].text, "NOT on disk"));
  }
}

TEST_CASE("a full disk does not keep a host from a ban, and the answer says that it is not saved",
          "[admin][rights]") {
  RightsBench bench;
  WorldServer& world = bench.bench.server;
  const Clocks now = bench.bench.now();
  bench.bench.environment.disk_has_space = false;
  world.set_disk_is_full(true, now);
  bench.order("ban 203.0.113.9");
  bench.services.tick(now);
  REQUIRE(bench.answers.size() == 1);
  CHECK(bench.answers[0].is_unsaved);
  CHECK(has(bench.answers[0].text, "in force, not on disk yet: the world's disk is full"));
  CHECK(world.rights().state().restrictions().size() == 1);
}

}  // namespace runstone::test
