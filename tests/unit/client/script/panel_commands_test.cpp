// The commands of a script for map, timeline and rollback.
#include <catch2/catch.hpp>

#include "tests/unit/client/script/script_bench.hpp"

using namespace runstone;
using runstone::test::ScriptBench;

namespace {

using Input = std::vector<std::string>;

}  // namespace

TEST_CASE_METHOD(ScriptBench, "a script shows the map and waits until it is drawn",
                 "[client_script]") {
  load("map full\nmap zoom 4\nmap on\nmap off\nscreenshot a.png\n");
  host.is_loading_panels = true;
  runner->step(0);
  runner->step(1);
  CHECK(host.input == Input{"map full"});
  host.is_loading_panels = false;
  for (TimeUs now = 2; now < 10; ++now) runner->step(now);
  CHECK(host.input == Input{"map full", "zoom 4", "map on", "map off"});
}

TEST_CASE_METHOD(ScriptBench, "a map that is never drawn ends the script", "[client_script]") {
  load("map on\ntimeline on\n");
  host.is_loading_panels = true;
  runner->step(0);
  runner->step(121'000'000);
  CHECK(runner->finished());
  REQUIRE(runner->failures().size() == 1);
  CHECK(runner->failures()[0] == "s.txt:1: the map was not drawn in time");
}

TEST_CASE_METHOD(ScriptBench, "a script previews, applies and undoes a rollback",
                 "[client_script]") {
  load(
      "rollback preview author \"the mole\" since 1h # all\nrollback apply\nrollback undo\n"
      "rollback forget\n");
  host.is_rolling_back = true;
  runner->step(0);
  runner->step(1);
  CHECK(host.input == Input{"preview author \"the mole\" since 1h # all"});
  host.is_rolling_back = false;
  for (TimeUs now = 2; now < 10; ++now) runner->step(now);
  CHECK(host.input.size() == 4);
  CHECK(host.input.back() == "forget");
  CHECK(runner->failures().empty());
}

TEST_CASE_METHOD(ScriptBench, "a refused rollback is a failure, and one that cannot begin ends",
                 "[client_script]") {
  load("rollback preview since 1h\nrollback apply\n");
  host.is_rollback_ok = false;
  runner->step(0);
  host.rollback_refusal = "there is no preview of a rollback";
  for (TimeUs now = 1; now < 5; ++now) runner->step(now);
  REQUIRE(runner->finished());
  REQUIRE_FALSE(runner->failures().empty());
  CHECK(runner->failures()[0] == "s.txt:1: the server refused the rollback");
}

TEST_CASE("wrong commands of map, timeline and rollback are found before the script runs",
          "[client_script]") {
  for (const char* line :
       {"map", "map open", "map zoom", "map zoom 0", "map on 3", "timeline", "timeline full",
        "rollback", "rollback preview", "rollback redo", "rollback apply p1"}) {
    CAPTURE(line);
    CHECK_FALSE(parse_script(line, "s.txt").has_value());
  }
  CHECK_FALSE(parse_script("rollback preview " + std::string(1'024, 'a'), "s.txt").has_value());
}
