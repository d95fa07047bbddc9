#include "server/admin/command_call.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "tests/unit/server/admin/parsed_command.hpp"

namespace runstone::test {
namespace {

CommandCaller caller_of(std::uint8_t who, bool is_operator = false) {
  return {who, {PublicKey{who}, is_operator}};
}

}  // namespace

TEST_CASE("a refusal names the missing right and the caller's role", "[admin][rights]") {
  RightsState state;
  state.apply(SetDefaultRole{kBuilderRole}, {1, 0, kTypedUs});
  CHECK(why_not(caller_of(1), state, command_of("log").row->rule, kTypedUs) ==
        "this command needs the right roll_back; your role is builder");
  state.apply(GrantRole{PublicKey{1}, kVisitorRole}, {2, 0, kTypedUs});
  CHECK(why_not(caller_of(1), state, command_of("unprotect a").row->rule, kTypedUs) ==
        "this command needs the right claim or protect; your role is visitor");
  CHECK(why_not(caller_of(1), state, command_of("help").row->rule, kTypedUs) == std::nullopt);
  CHECK(why_not(caller_of(2), state, command_of("undo").row->rule, kTypedUs) == std::nullopt);
  state.apply(Restrict{RestrictionKind::freeze, PublicKey{2}, 0, "griefing"}, {3, 0, kTypedUs});
  CHECK(why_not(caller_of(2), state, command_of("undo").row->rule, kTypedUs) ==
        "you are frozen: griefing");

  const CommandCaller console;
  for (const char* line : {"stop", "backup copy", "log"})
    CHECK(why_not(console, state, command_of(line).row->rule, kTypedUs) == std::nullopt);
  CHECK(why_not(caller_of(3, true), state, command_of("stop").row->rule, kTypedUs) == std::nullopt);
  CHECK(why_not(caller_of(3, true), state, command_of("reload").row->rule, kTypedUs) ==
        "this command is for the console and `runstone-server control`");
}

}  // namespace runstone::test
