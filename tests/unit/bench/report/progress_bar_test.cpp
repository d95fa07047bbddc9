#include "tests/bench/report/progress_bar.hpp"

#include <catch2/catch.hpp>
#include <sstream>

namespace runstone::bench {
namespace {

TEST_CASE("durations have the unit that fits") {
  CHECK(duration_text(0.4) == "0 s");
  CHECK(duration_text(99) == "99 s");
  CHECK(duration_text(150) == "3 min");
  CHECK(duration_text(7'200) == "2 h 0 min");
}

TEST_CASE(
    "without a terminal there is a line for each step, with the remaining time from the pace so "
    "far") {
  std::ostringstream out;
  ProgressBar bar(out, false, 3, 90);
  bar.begin("first");
  bar.end("is there", 30, 0);
  bar.begin("second");
  bar.end("60 s", 30, 60);  // twice as long as expected
  bar.begin("third");
  bar.end("failed: why", 30, 0);
  CHECK(out.str().find("[1/3] first") != std::string::npos);
  CHECK(out.str().find("is there; about 60 s left") != std::string::npos);
  CHECK(out.str().find("60 s; about 60 s left") != std::string::npos);
  CHECK(out.str().find("failed: why\n") != std::string::npos);
  CHECK(out.str().find('\r') == std::string::npos);
}

TEST_CASE("on a terminal the bar grows in one line") {
  std::ostringstream out;
  ProgressBar bar(out, true, 2, 10);
  bar.begin("first");
  bar.end("5 s", 5, 5);
  CHECK(out.str().find("[........................] 0/2") != std::string::npos);
  CHECK(out.str().find("[############............] 1/2") != std::string::npos);
}

}  // namespace
}  // namespace runstone::bench
