#include "server/admin/joined_replies.hpp"

#include <catch2/catch.hpp>
#include <string>

namespace runstone::test {

TEST_CASE("the answers of several parts become one, in the order of the parts", "[admin]") {
  std::vector<CommandAnswer> answers;
  const auto replies =
      joined_replies([&](const CommandAnswer& answer) { answers.push_back(answer); }, 3);
  replies[2](CommandAnswer::last("third"));
  replies[0](CommandAnswer::progress("working"));
  REQUIRE(answers.size() == 1);
  CHECK(answers[0].text == "working");
  replies[0](CommandAnswer::last("first"));
  CHECK(answers.size() == 1);
  SECTION("all succeed") {
    replies[1](CommandAnswer::last("second"));
    REQUIRE(answers.size() == 2);
    CHECK(answers[1].is_ok);
  }
  SECTION("one fails") {
    replies[1](CommandAnswer::last("second", false));
    REQUIRE(answers.size() == 2);
    CHECK_FALSE(answers[1].is_ok);
  }
  CHECK(answers[1].is_done);
  CHECK(answers[1].text == "first\nsecond\nthird");
}

TEST_CASE("parts that are not on disk yet are reported once, together", "[admin]") {
  std::vector<CommandAnswer> answers;
  const auto replies =
      joined_replies([&](const CommandAnswer& answer) { answers.push_back(answer); }, 2);
  replies[0](CommandAnswer::unsaved("a; not on disk yet"));
  CHECK(answers.empty());
  replies[1](CommandAnswer::unsaved("b; not on disk yet"));
  REQUIRE(answers.size() == 1);
  CHECK(answers[0].is_unsaved);
  CHECK(answers[0].text == "a; not on disk yet\nb; not on disk yet");
  replies[0](CommandAnswer::last("a"));
  CHECK(answers.size() == 1);
  replies[1](CommandAnswer::last("b"));
  REQUIRE(answers.size() == 2);
  CHECK(answers[1].is_done);
  CHECK(answers[1].text == "a\nb");
}

TEST_CASE("a command of one part has the reply itself", "[admin]") {
  std::string text;
  joined_replies([&](const CommandAnswer& answer) { text = answer.text; },
                 1)[0](CommandAnswer::unsaved("a"));
  CHECK(text == "a");
}

}  // namespace runstone::test
