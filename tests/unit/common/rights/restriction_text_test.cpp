#include "common/rights/restriction_text.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {

TEST_CASE("the text of a restriction has its end and its reason, if there are any", "[rights]") {
  const TimeUs until_us = 1'796'083'200'000'000;
  Restrict restriction;
  CHECK(restriction_text("you are muted", restriction) == "you are muted");
  restriction.until_us = until_us;
  CHECK(restriction_text("you are muted", restriction) ==
        "you are muted until 2026-12-01T00:00:00Z");
  restriction.reason = "noise";
  CHECK(restriction_text("you are muted", restriction) ==
        "you are muted until 2026-12-01T00:00:00Z: noise");
  restriction.until_us = 0;
  CHECK(restriction_text("you are muted", restriction) == "you are muted: noise");
}

}  // namespace runstone::test
