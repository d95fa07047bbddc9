#include "client/play/time_travel.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {

TEST_CASE("the text of a moment has the edit and the time", "[client]") {
  CHECK(moment_text(std::nullopt).empty());
  CHECK(moment_text(PastMoment{7, 1'700'000'000'999'999}) ==
        "the past: after edit 7 (2023-11-14 22:13:20 UTC)");
  CHECK(moment_text(PastMoment{8, 5'000'000'000'000'000}) ==
        "the past: after edit 8 (2128-06-11 08:53:20 UTC)");
  CHECK(moment_text(PastMoment{0, 0}) == "the past: after edit 0");
}

}  // namespace runstone::test
