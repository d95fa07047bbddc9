// The commands of a script for map, timeline, rollback and the library of builds.
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

TEST_CASE_METHOD(ScriptBench, "a script lists, takes and adds builds, and waits for each",
                 "[client_script]") {
  load("library list\nlibrary list name old mill\nlibrary take 120\nlibrary add new mill # 2\n");
  host.is_using_library = true;
  runner->step(0);
  runner->step(1);
  CHECK(host.input == Input{"list "});
  host.is_using_library = false;
  for (TimeUs now = 2; now < 10; ++now) runner->step(now);
  CHECK(host.input == Input{"list ", "list old mill", "take 120", "add new mill # 2"});
  CHECK(runner->finished());
  CHECK(runner->failures().empty());
}

TEST_CASE_METHOD(ScriptBench, "a build that cannot be taken ends the script with the reason",
                 "[client_script]") {
  load("library take 120\nlibrary add mill\n");
  host.library_refusal = "there is no build 120";
  runner->step(0);
  CHECK(runner->finished());
  CHECK(host.input == Input{"take 120"});
  CHECK(runner->failures() == Input{"s.txt:1: there is no build 120"});
}

TEST_CASE_METHOD(ScriptBench, "a library that does not answer ends the script", "[client_script]") {
  load("library add mill\n");
  host.is_using_library = true;
  runner->step(0);
  runner->step(599'000'000);
  CHECK_FALSE(runner->finished());
  runner->step(600'000'000);
  CHECK(runner->failures() == Input{"s.txt:1: the library of builds did not answer in time"});
}

TEST_CASE_METHOD(ScriptBench, "a script shows the window of the library with its list",
                 "[client_script]") {
  load("library on\nlibrary off\n");
  host.is_loading_panels = true;
  runner->step(0);
  runner->step(1);
  CHECK(host.input == Input{"library on"});
  host.is_loading_panels = false;
  for (TimeUs now = 2; now < 6; ++now) runner->step(now);
  CHECK(host.input == Input{"library on", "library off"});
}

TEST_CASE("wrong commands of map, timeline, rollback and library are found before the script runs",
          "[client_script]") {
  for (const char* line : {"map",
                           "map open",
                           "map zoom",
                           "map zoom 0",
                           "map on 3",
                           "timeline",
                           "timeline full",
                           "rollback",
                           "rollback preview",
                           "rollback redo",
                           "rollback apply p1",
                           "library",
                           "library show",
                           "library take",
                           "library take 0",
                           "library take mill",
                           "library take 1 2",
                           "library add",
                           "library list mill",
                           "library list name",
                           "library on 1"}) {
    CAPTURE(line);
    CHECK_FALSE(parse_script(line, "s.txt").has_value());
  }
  CHECK_FALSE(parse_script("rollback preview " + std::string(1'024, 'a'), "s.txt").has_value());
}
