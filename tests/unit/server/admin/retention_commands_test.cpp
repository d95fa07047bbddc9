#include "server/admin/retention_commands.hpp"

#include <catch2/catch.hpp>
#include <optional>
#include <vector>

#include "tests/unit/server/admin/command_bench.hpp"
#include "tests/unit/server/admin/parsed_command.hpp"

namespace runstone::test {
namespace {

struct RetentionCommandBench : CommandBench {
  RetentionCommandBench() {
    OperatorActions actions;
    actions.retention_state = [this] { return state; };
    actions.run_retention = [this](std::uint64_t days) {
      runs.push_back(days);
      return can_run;
    };
    actions.stop_retention = [this] { return state.is_running; };
    services.emplace(CommandServices{bench.server, service, *this, placing, folder.path(), actions,
                                     [](const PublicKey&) { return false; }});
  }
  CommandAnswer give(const std::string& line) {
    answers.clear();
    give_command({*services, {}, bench.now(), reply()}, line);
    for (int i = 0; i < 3; ++i) {
      run_all();
      services->tick(bench.now());
    }
    return answer();
  }
  std::optional<CommandServices> services;
  RetentionState state;
  std::vector<std::uint64_t> runs;
  bool can_run = true;
};

RetentionPlan sample_plan() {
  RetentionPlan plan;
  plan.days = 30;
  plan.cut = {{2, 900}, 1'700'000'000'000'000};
  plan.newest = {{3, 1'000}, 1'703'000'000'000'000};
  plan.volume = {900, 84'000, 2, 5'000, 9'000, {{Cause::rollback, 4}, {Cause::import, 1}}};
  plan.free = {0, true, true};
  return plan;
}

}  // namespace

TEST_CASE("the lines about retention are parsed", "[admin][retention]") {
  CHECK(row_of("retention") == "retention");
  CHECK(row_of("retention preview") == "retention preview");
  CHECK(row_of("retention preview 30") == "retention preview");
  CHECK(row_of("retention run 30 anyway") == "retention run");
  CHECK(row_of("retention stop") == "retention stop");
  CHECK(mistake("retention run -5") == "retention run \"-5\": a number from 0 to 36500");
  CHECK(mistake("retention preview 2099-01-01") ==
        "retention preview \"2099-01-01\": a number from 0 to 36500");
  CHECK(mistake("retention run 30 days") == "retention run DAYS \"days\": nothing comes after it");
}

TEST_CASE("a plan as text names what goes, what stays, the bytes and the reach",
          "[admin][retention]") {
  CHECK(
      retention_plan_text(sample_plan()) ==
      "goes        900 edits up to seq=900 (2023-11-14T22:13:20Z), of them by cause: rollback 4, "
      "import 1; 2 keyframes\n"
      "stays       100 edits of 30 days before the newest one (2023-12-19T15:33:20Z); the ground as "
      "it is; rights, materials, shapes, textures, clock, names, watermarks and the library\n"
      "bytes       about 82.0 KiB of edits and 4.8 KiB of keyframes; the base takes at most 8.7 KiB "
      "of them\n"
      "file        the free space goes back to the disk, in parts, at the end\n"
      "reach       time travel, rollback and undo go back to seq=900 (2023-11-14T22:13:20Z), and now "
      "to the first edit");
  RetentionPlan plan = sample_plan();
  plan.free.can_be_given_back = false;
  plan.head = {{1, 50}, 1'600'000'000'000'000};
  plan.doubt = "the time steps";
  const std::string text = retention_plan_text(plan);
  CHECK(text.find("new edits use the free space") != std::string::npos);
  CHECK(text.find("and now to seq=50 (2020-09-13T12:26:40Z)") != std::string::npos);
  CHECK(text.find("\nDOUBT       the time steps. A policy waits here") != std::string::npos);
  plan.free.is_in_file = false;
  CHECK(retention_plan_text(plan).find("the database uses the free space for new rows") !=
        std::string::npos);
  plan.cut = plan.head;
  CHECK(retention_plan_text(plan) ==
        "nothing would go: no edit of the log is older than 30 days before the newest one "
        "(2023-12-19T15:33:20Z)\n"
        "reach       time travel, rollback and undo go back to seq=50 (2020-09-13T12:26:40Z)");
}

TEST_CASE("the state of retention as text", "[admin][retention]") {
  RetentionState state;
  CHECK(retention_state_text(state) ==
        "retention: off, every edit stays in the log (retention_days = 0)\n"
        "since the start: 0 edits removed in 0 parts");
  state.days = 90;
  state.head = {{1, 700}, 1'700'000'000'000'000};
  state.is_running = true;
  state.cut = 1'000;
  state.waits_for = "an undo";
  state.edits = 700;
  state.parts = 2;
  state.writer_us = 30'000;
  state.writer_us_max = 18'000;
  state.failure = "the disk is full";
  state.failures = 2;
  CHECK(
      retention_state_text(state) ==
      "retention: edits stay in the log for 90 days\n"
      "history: removed by retention up to seq=700 (2023-11-14T22:13:20Z); time travel, rollback and "
      "undo reach back to there\n"
      "under way: 300 edits to go, up to seq=1000; it waits: an undo\n"
      "since the start: 700 edits removed in 2 parts, of 15 ms of the log writer (18 ms at most)\n"
      "RETENTION FAILS, 2 times: the disk is full");
  CHECK(retention_counters(state) ==
        "retention_days=90 retention_running=1 retention_head=700 retention_edits=700 "
        "retention_parts=2 retention_writer_us=30000 retention_writer_us_max=18000 "
        "retention_failures=2");
}

TEST_CASE("a run is refused with words before it acts", "[admin][retention]") {
  RetentionCommandBench bench;
  CHECK(bench.give("retention").text.starts_with("retention: off"));
  CHECK(
      bench.give("retention preview").text ==
      "retention preview: no policy is set (retention_days = 0): say how many days of edits stay, as "
      "in `retention preview 30`");
  const CommandAnswer none = bench.give("retention run 0 anyway");
  CHECK_FALSE(none.is_ok);
  CHECK(none.text.find("0 days would keep no edit") != std::string::npos);
  CHECK(bench.give("retention run 30").text.starts_with("nothing would go"));
  CHECK(bench.give("retention preview 30").text.starts_with("nothing would go"));
  CHECK(bench.runs.empty());
  CHECK(bench.give("retention stop").text == "retention stop: none is under way");
  bench.state.is_running = true;
  CHECK(bench.give("retention stop").is_ok);
}

}  // namespace runstone::test
