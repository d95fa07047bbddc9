// runstone-bot: many players in one process. Exit codes: 0 played to the end, 1 something was lost, drifted or, of
// a recorded log, refused, 2 could not start (docs/bots.md).
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <csignal>
#include <cstdio>
#include <exception>

#include "client/app/bot_fleet.hpp"
#include "client/app/client.hpp"
#include "client/app/play_fleet.hpp"
#include "client/app/recorded_file.hpp"
#include "client/app/report.hpp"

namespace {

volatile std::sig_atomic_t stop_requested = 0;

void request_stop(int) { stop_requested = stop_requested + 1; }

int play(const runstone::BotOptions& options) {
  using namespace runstone;
  const auto log = read_recorded_file(options.play);
  if (!log) {
    std::fprintf(stderr, "runstone-bot: %s\n", log.error().c_str());
    return kExitNoStart;
  }
  const PlayReport report = PlayFleet(options, *log).run(stop_requested);
  if (!report.started) {
    std::fprintf(stderr, "runstone-bot: %s\n", report.failure.c_str());
    return kExitNoStart;
  }
  std::fputs(to_table(report).c_str(), stdout);
  if (!report.failure.empty()) std::fprintf(stderr, "runstone-bot: %s\n", report.failure.c_str());
  if (!options.report.empty() && !write_text(options.report, to_json(report))) {
    std::fprintf(stderr, "runstone-bot: %s: cannot be written\n", options.report.c_str());
    return kExitFailed;
  }
  return report.is_complete() ? kExitOk : kExitFailed;
}

int run(const runstone::BotOptions& options) {
  using namespace runstone;
  if (!options.play.empty()) return play(options);
  BotFleet fleet(options);
  const FleetReport report = fleet.run(stop_requested);
  std::fputs(to_table(report).c_str(), stdout);
  if (!report.failure.empty()) std::fprintf(stderr, "runstone-bot: %s\n", report.failure.c_str());
  if (!options.report.empty() && !write_text(options.report, to_json(report))) {
    std::fprintf(stderr, "runstone-bot: %s: cannot be written\n", options.report.c_str());
    return kExitFailed;
  }
  if (!report.failure.empty()) return report.counts.due == 0 ? kExitNoStart : kExitFailed;
  return report.drifted == 0 ? kExitOk : kExitFailed;
}

}  // namespace

int main(int argc, char** argv) {
  const auto parsed = runstone::parse_bot_options(argc, argv);
  if (!parsed.options) return parsed.exit_code;
  spdlog::set_default_logger(spdlog::stderr_logger_mt("bot"));  // standard output is for the table
  spdlog::set_level(parsed.options->verbose ? spdlog::level::debug : spdlog::level::info);
  struct sigaction action{};
  action.sa_handler = request_stop;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  int code = runstone::kExitNoStart;
  try {
    code = run(*parsed.options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "runstone-bot: %s\n", error.what());
  }
  spdlog::shutdown();
  return code;
}
