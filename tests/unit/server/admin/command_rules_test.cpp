#include "server/admin/command_rules.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "server/admin/command_caller.hpp"

namespace runstone::command_rules_test {
namespace {

constexpr TimeUs kNow = 1'800'000'000'000'000;

CommandRule rule(const std::string& line) {
  CAPTURE(line);
  const auto command = parse_command(line, kNow);
  REQUIRE(command.has_value());
  return rule_of(*command);
}

CommandCaller caller_of(std::uint8_t who, bool is_operator = false) {
  return {who, {PublicKey{who}, is_operator}};
}

}  // namespace

TEST_CASE("each command needs its right", "[admin][rights]") {
  for (const char* line : {"help", "players", "materials", "roles", "protected", "why ana see"})
    CHECK(rule(line).any_of == RightSet());
  for (const char* line : {"undo", "redo"}) CHECK(rule(line).any_of == RightSet{Right::undo});
  for (const char* line :
       {"claim a 0 0 0 1 1 1", "protect a 0 0 0 1 1 1", "protect a add ana", "unprotect a"}) {
    CHECK(rule(line).any_of == RightSet{Right::claim, Right::protect});
  }
  for (const char* line : {"status", "names", "kick ana", "ban ana", "mute ana", "freeze ana",
                           "unban ana", "bans", "chat log"}) {
    CHECK(rule(line).any_of == RightSet{Right::moderate});
  }
  for (const char* line :
       {"log", "rollback list", "rollback apply p1", "rollback preview since 1h"}) {
    CHECK(rule(line).any_of == RightSet{Right::roll_back});
  }
  for (const char* line : {"grant ana mason", "revoke ana", "grants"})
    CHECK(rule(line).any_of == RightSet{Right::grant});
  for (const char* line : {"role set mason see", "role remove mason", "role default mason",
                           "names release ana", "stop", "servers", "handover", "rights undo 3",
                           "password", "password clear", "say hello"}) {
    CHECK(rule(line).any_of == RightSet{Right::administer});
  }
  for (const char* line : {"backup copy", "reload", "materials add wool.toml", "password set"})
    CHECK(rule(line).is_local);
}

TEST_CASE("a refusal names the missing right and the caller's role", "[admin][rights]") {
  RightsState state;
  state.apply(SetDefaultRole{kBuilderRole}, {1, 0, kNow});
  CHECK(why_not(caller_of(1), state, rule("log"), kNow) ==
        "this command needs the right roll_back; your role is builder");
  state.apply(GrantRole{PublicKey{1}, kVisitorRole}, {2, 0, kNow});
  CHECK(why_not(caller_of(1), state, rule("unprotect a"), kNow) ==
        "this command needs the right claim or protect; your role is visitor");
  CHECK(why_not(caller_of(1), state, rule("help"), kNow) == std::nullopt);
  CHECK(why_not(caller_of(2), state, rule("undo"), kNow) == std::nullopt);
  state.apply(Restrict{RestrictionKind::freeze, PublicKey{2}, 0, "griefing"}, {3, 0, kNow});
  CHECK(why_not(caller_of(2), state, rule("undo"), kNow) == "you are frozen: griefing");

  const CommandCaller console;
  for (const char* line : {"stop", "backup copy", "log"})
    CHECK(why_not(console, state, rule(line), kNow) == std::nullopt);
  CHECK(why_not(caller_of(3, true), state, rule("stop"), kNow) == std::nullopt);
  CHECK(why_not(caller_of(3, true), state, rule("reload"), kNow) ==
        "this command is for the console and `runstone-server control`");
}

TEST_CASE("help lists what the caller may do", "[admin][rights]") {
  const auto lists = [](const std::string& text, const std::string& command) {
    return ("\n" + text).find("\n" + command) != std::string::npos;
  };
  const std::string none = command_help([](Right) { return false; }, false);
  CHECK(lists(none, "help "));
  CHECK(lists(none, "why PLAYER RIGHT "));
  for (const char* command :
       {"undo ", "claim ", "rollback ", "ban ", "grant ", "stop", "backup ", "FILTERS", "BOX"}) {
    CHECK_FALSE(lists(none, command));
  }
  const std::string undo = command_help([](Right right) { return right == Right::undo; }, false);
  CHECK(lists(undo, "redo "));
  CHECK_FALSE(lists(undo, "log "));
  const std::string all = command_help([](Right) { return true; }, false);
  for (const char* command : {"undo ", "claim ", "rollback apply ", "ban ", "grant ", "role set ",
                              "stop", "FILTERS", "BOX"}) {
    CHECK(lists(all, command));
  }
  CHECK_FALSE(lists(all, "backup "));
  CHECK(lists(command_help([](Right) { return true; }, true), "backup "));
}

}  // namespace runstone::command_rules_test
