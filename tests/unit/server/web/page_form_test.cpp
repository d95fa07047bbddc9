// The forms of the operators' page: what is taken from a browser, and the commands that follow.
#include "server/web/page_form.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "protocol/limits.hpp"
#include "server/web/operator_pages.hpp"
#include "tests/support/core/text_contains.hpp"

namespace runstone::test {
namespace {

Result<std::string, std::string> command_of(const std::string& form) {
  const auto fields = parse_form(form);
  REQUIRE(fields.has_value());
  return command_of_form(*fields);
}

}  // namespace

TEST_CASE("a form is refused if it is malformed, or could end the line of a command", "[web]") {
  for (const char* form : {"a=%", "a=%4", "a=%zz", "a=1&a=2", "a=x%0ado", "a=%00", "a=%1b[2J",
                           "a=%0d", "a=%c2%85", "a=%ff", "a%0a=x"}) {
    CAPTURE(form);
    CHECK_FALSE(parse_form(form).has_value());
  }
  const auto read = parse_form("a=x+y%2B&b&&c=%C3%A9");
  REQUIRE(read.has_value());
  CHECK(field_of(*read, "a") == "x y+");
  CHECK(field_of(*read, "b").empty());
  CHECK(field_of(*read, "c") == "\xc3\xa9");
}

TEST_CASE("the value of a field stays one word of the command", "[web]") {
  CHECK(*command_of("action=kick&who=ana+reason+x") == "kick \"ana reason x\"");
  CHECK_FALSE(command_of("action=kick&who=ana%22+reason+%22x").has_value());
  CHECK_FALSE(command_of("action=restrict&kind=stop&who=ana").has_value());
  CHECK_FALSE(command_of("action=restrict&kind=ban&who=ana&for=2h%22x").has_value());
  CHECK_FALSE(command_of("action=stop").has_value());
  CHECK_FALSE(command_of("action=").has_value());
}

TEST_CASE("a line that the server would not take is refused with its bound", "[web]") {
  const std::string longest(kCommandBytesMax, 'x');
  CHECK(command_of("action=command&line=" + longest).has_value());
  const auto line = command_of("action=command&line=" + longest + "x");
  REQUIRE_FALSE(line.has_value());
  CHECK(contains(line.error(), "at most " + std::to_string(kCommandBytesMax)));
  CHECK_FALSE(command_of("action=kick&who=" + longest).has_value());
  CHECK_FALSE(log_command_of({{"author", longest}}).has_value());
}

TEST_CASE("the cookie of another name, or two of this name, is none", "[web]") {
  CHECK(cookie_of("a=1; name=x; b=2", "name") == "x");
  CHECK(cookie_of("xname=1; names=2", "name").empty());
  CHECK(cookie_of("name=x; name=y", "name").empty());
  CHECK(cookie_of("name", "name").empty());
}

TEST_CASE("only the answer to a preview offers to apply one", "[web]") {
  PageReply reply;
  reply.kind = PageReply::Kind::known;
  reply.end = PageReply::End::ok;
  reply.lines = {"nothing has changed yet: `rollback apply p3` does it"};
  const OperatorView view{"w", "ana", "moderator", "roll_back", std::string(64, 'f')};
  CHECK(contains(operator_answer(view, "rollback preview author \"eve\"", reply), "apply p3</b"));
  CHECK_FALSE(contains(operator_answer(view, "chat log", reply), "apply p3</b"));
}

}  // namespace runstone::test
