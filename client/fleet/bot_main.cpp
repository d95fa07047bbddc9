// runstone-bot: many players in one process. docs/bots.md lists the exit codes.
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <csignal>
#include <cstdio>

#include "client/fleet/behaviour_fleet.hpp"
#include "client/fleet/play_fleet.hpp"
#include "client/fleet/recorded_file.hpp"
#include "client/report/exit_code.hpp"
#include "client/report/report.hpp"
#include "common/os/output_file.hpp"
#include "common/os/program.hpp"
#include "common/os/stop_signals.hpp"

namespace {

/// Prints the table of a report and writes the file of --report. Returns `code`, or kExitFailed if
/// that file cannot be written.
template <class Report>
int finish(const Report& report, const runstone::BotOptions& options, int code) {
  using namespace runstone;
  std::fputs(to_table(report).c_str(), stdout);
  if (!report.failure.empty()) std::fprintf(stderr, "runstone-bot: %s\n", report.failure.c_str());
  if (options.report.empty()) return code;
  const auto written = write_output_file(options.report, to_json(report));
  if (written) return code;
  std::fprintf(stderr, "runstone-bot: %s\n", written.error().c_str());
  return kExitFailed;
}

int play(const runstone::BotOptions& options, const volatile std::sig_atomic_t& stop) {
  using namespace runstone;
  const auto log = read_recorded_file(options.play);
  if (!log) {
    std::fprintf(stderr, "runstone-bot: %s\n", log.error().c_str());
    return kExitNoStart;
  }
  const PlayReport report = PlayFleet(options, *log).run(stop);
  if (!report.started) {
    std::fprintf(stderr, "runstone-bot: %s\n", report.failure.c_str());
    return kExitNoStart;
  }
  return finish(report, options, report.is_complete() ? kExitOk : kExitFailed);
}

int run(const runstone::BotOptions& options, const volatile std::sig_atomic_t& stop) {
  using namespace runstone;
  if (!options.play.empty()) return play(options, stop);
  const FleetReport report = BehaviourFleet(options).run(stop);
  int code = report.is_sound() ? kExitOk : kExitFailed;
  if (!report.failure.empty()) code = report.counts.due == 0 ? kExitNoStart : kExitFailed;
  return finish(report, options, code);
}

int bot_program(int argc, char** argv) {
  const auto parsed = runstone::parse_bot_options(argc, argv);
  if (!parsed.options) return parsed.exit_code;
  spdlog::set_default_logger(spdlog::stderr_logger_mt("bot"));  // standard output is for the table
  spdlog::set_level(parsed.options->verbose ? spdlog::level::debug : spdlog::level::info);
  const volatile std::sig_atomic_t& stop = runstone::count_stop_signals();
  const int code = run(*parsed.options, stop);
  spdlog::shutdown();
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  return runstone::run_program("runstone-bot", runstone::kExitNoStart,
                               [&] { return bot_program(argc, argv); });
}
