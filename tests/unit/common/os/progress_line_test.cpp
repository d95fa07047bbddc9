#include "common/os/progress_line.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("a progress line has the progress and the time left", "[progress]") {
  CHECK(progress_text("edits", 0, 250, 1000, 10) == "edits: 250 of 1000, 30 s left");
  CHECK(progress_text("edits", 200, 250, 1000, 10) == "edits: 250 of 1000, 3 min left");
  CHECK(progress_text("edits", 0, 1000, 1000, 10) == "edits: 1000 of 1000, 0 s left");
  CHECK(progress_text("edits", 0, 250, 1000, 0.5) ==
        "edits: 250 of 1000");  // no estimate in the first second
  CHECK(progress_text("edits", 250, 250, 1000, 10) == "edits: 250 of 1000");  // no progress yet
}
