#include "common/patterns/pattern_parser.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/common/patterns/random_pattern.hpp"

namespace runstone::test {
namespace {

std::string canonical(std::string_view text) {
  const auto pattern = parse_pattern(text);
  return pattern ? text_of(*pattern) : pattern.error().message();
}

std::string repeated(std::string_view text, int times) {
  std::string out;
  while (times-- > 0) out += text;
  return out;
}

}  // namespace

TEST_CASE("a pattern is read into a mix and a filter", "[patterns]") {
  const auto pattern =
      parse_pattern("70% stone, 30% (noise 8: \"oak planks\", moss) where not is air and above 40");
  REQUIRE(pattern);
  const Mix& mix = pattern->mix;
  CHECK(mix.kind == MixKind::list);
  REQUIRE(mix.parts.size() == 2);
  CHECK(mix.parts[0].weight == 70);
  CHECK(mix.parts[0].material.name == "stone");
  CHECK(mix.parts[0].material.column == 5);
  CHECK(mix.parts[1].weight == 30);
  CHECK(mix.parts[1].kind == MixKind::clumps);
  CHECK(mix.parts[1].size == 8);
  CHECK(mix.parts[1].parts[0].material.name == "oak planks");
  REQUIRE(pattern->filter);
  CHECK(pattern->filter->kind == FilterKind::all);
  REQUIRE(pattern->filter->parts.size() == 2);
  CHECK(pattern->filter->parts[0].kind == FilterKind::negation);
  CHECK(pattern->filter->parts[1].number == 40);
  const auto gradient = parse_mix("y -5..20: grass, stone");
  REQUIRE(gradient);
  CHECK(gradient->kind == MixKind::height);
  CHECK(gradient->low == -5);
  CHECK(gradient->high == 20);
}

TEST_CASE("the canonical text is the shortest one that says the same", "[patterns]") {
  CHECK(canonical("  70%stone ,20 % \"andesite\"  ") == "70% stone, 20% andesite");
  CHECK(canonical("((stone))") == "stone");
  CHECK(canonical("5% stone") == "stone");
  CHECK(canonical("\"y\", \"a \\\"b\\\" \\\\ c\", \"3d\"") ==
        "\"y\", \"a \\\"b\\\" \\\\ c\", \"3d\"");
  CHECK(canonical("default:chest") == "default:chest");
  CHECK(canonical("(distance 0..9:a,b),c") == "(distance 0..9: a, b), c");
  CHECK(canonical("a where (is b and (solid and exposed)) or ((on c))") ==
        "a where is b and solid and exposed or on c");
  CHECK(canonical("a where not (is b) and (solid or exposed)") ==
        "a where not is b and (solid or exposed)");
  CHECK(canonical("a where not (solid and exposed)") == "a where not (solid and exposed)");
  CHECK(canonical("a where is b or c or solid or is \"solid\"") ==
        "a where is b or c or solid or is \"solid\"");
  CHECK(canonical("a where noise 30% 1") == "a where noise 30%");
}

TEST_CASE("a mistake is told with its column, what is there and what was expected", "[patterns]") {
  const std::vector<std::pair<std::string, std::string>> kMistakes = {
      {"", "column 1: found the end but expected a material"},
      {"stone moss", "column 7: found \"moss\" but expected \",\", \"where\" or the end"},
      {"stone, ", "column 8: found the end but expected a material"},
      {"stone where",
       "column 12: found the end but expected a condition: is, on, under, beside, "
       "exposed, solid, above, below, noise, not or \"(\""},
      {"70 stone", "column 4: found \"stone\" but expected \"%\""},
      {"0% stone", "column 1: found \"0\" but expected a weight from 1 to 10000"},
      {"10001% stone", "column 1: found \"10001\" but expected a weight from 1 to 10000"},
      {"1234567890% stone", "column 1: a number has at most nine digits"},
      {"70% a, b", "column 8: found \"b\" but expected a weight"},
      {"a, 70% b", "column 4: found \"70\" but expected a material without a weight"},
      {"y 1..9: 5% a, b", "column 9: found \"5\" but expected a material without a weight"},
      {"y 9..1: a, b", "column 6: found \"1\" but expected a number above 9"},
      {"y 1 9: a, b", "column 5: found \"9\" but expected \"..\""},
      {"y 1..9: a", "column 10: found the end but expected \",\" and a second material"},
      {"distance -1..9: a, b", "column 10: found \"-1\" but expected a number within the world"},
      {"noise 257: a, b", "column 7: found \"257\" but expected a size from 1 to 256"},
      {"noise 8 a", "column 9: found \"a\" but expected \":\""},
      {"wh\xC3\xA9re\xE2\x82\xAC, $", "column 9: found \"$\" but expected a material"},
      {"\"oak planks", "column 1: the name has no closing quote"},
      {"a, \"\"", "column 4: the name of a material has 1 to 64 bytes"},
      {"a where is", "column 11: found the end but expected a material"},
      {"a where is b or and",
       "column 17: found \"and\" but expected a condition: is, on, under, "
       "beside, exposed, solid, above, below, noise, not or \"(\""},
      {"a where (solid", "column 15: found the end but expected \")\""},
      {"a where solid)", "column 14: found \")\" but expected \"and\", \"or\" or the end"},
      {"a where \"solid\"",
       "column 9: found \"solid\" but expected a condition: is, on, under, beside, exposed, solid, "
       "above, below, noise, not or \"(\""},
      {"a where noise 101%", "column 15: found \"101\" but expected a percentage from 0 to 100"},
      {"a where above stone", "column 15: found \"stone\" but expected a height within the world"},
      {"where solid", "column 1: found \"where\" but expected a material"},
      {"a\tb", "column 1: the text is not UTF-8, or has control characters"},
      {std::string("a\0b", 3), "column 1: the text is not UTF-8, or has control characters"},
      {repeated("a", 1025), "column 1: the text has more than 1024 bytes"},
      {repeated("a,", 500) + "a", "column 1: with its blanks the text has more than 1024 bytes"},
      {repeated("a", 65), "column 1: the name of a material has 1 to 64 bytes"},
      {repeated("(", 1000), "column 18: nested more than 16 levels deep"},
      {"a where " + repeated("not ", 200) + "solid", "column 77: nested more than 16 levels deep"},
  };
  for (const auto& [text, message] : kMistakes) {
    CAPTURE(text);
    const auto pattern = parse_pattern(text);
    REQUIRE_FALSE(pattern);
    CHECK(pattern.error().message() == message);
  }
}

TEST_CASE("the canonical text of a random pattern is read back to the same pattern",
          "[patterns][property]") {
  SplitMix64 rng(Catch::rngSeed() + 51);
  RandomPattern random(rng);
  std::size_t read = 0;
  for (int round = 0; round < 2'000; ++round) {
    const std::string text = random.mix() + " where " + random.filter();
    CAPTURE(text);
    const auto pattern = parse_pattern(text);
    if (!pattern) {
      // Only their length is wrong with random texts.
      REQUIRE(pattern.error().what.find("1024 bytes") != std::string::npos);
      continue;
    }
    ++read;
    const std::string written = text_of(*pattern);
    const auto again = parse_pattern(written);
    REQUIRE(again);
    REQUIRE(*again == *pattern);
    REQUIRE(text_of(*again) == written);
    REQUIRE(parse_mix(text_of(pattern->mix)));
    REQUIRE(parse_filter(text_of(*pattern->filter)));
  }
  CHECK(read > 1'500);
}

TEST_CASE("the chips of a pattern are its parts", "[patterns]") {
  const auto chips = [](std::string_view text) { return chips_of(*parse_pattern(text)); };
  using Chips = std::vector<std::string>;
  CHECK(chips("stone") == Chips{"stone"});
  CHECK(chips("noise 8: 60%a, 40%b where is c and (solid or exposed)") ==
        Chips{"noise 8:", "60% a", "40% b", "where", "is c", "(solid or exposed)"});
  CHECK(chips("a, b where solid or exposed") == Chips{"a", "b", "where", "solid or exposed"});
}

}  // namespace runstone::test
