#include "server/replay/replay_commands.hpp"

#include <algorithm>
#include <chrono>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <ostream>
#include <vector>

#include "common/core/hex.hpp"
#include "common/os/progress_line.hpp"
#include "common/os/steady_clock.hpp"
#include "server/replay/command_world.hpp"
#include "server/replay/replayer.hpp"
#include "server/replay/subcommand.hpp"

namespace runstone {
namespace {

using Clock = std::chrono::steady_clock;

/// Returns the middle value, or the mean of the two middle values. Requires at least one value.
double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

double rate(std::uint64_t edits, double seconds) {
  return seconds > 0 ? static_cast<double>(edits) / seconds : 0;
}

void print_times(std::ostream& out, const char* name, std::uint64_t edits,
                 const std::vector<double>& seconds) {
  const auto [low, high] = std::minmax_element(seconds.begin(), seconds.end());
  row(out, name) << std::fixed << std::setprecision(4) << median(seconds) << " s (" << *low
                 << " to " << *high << "), " << std::setprecision(0) << rate(edits, median(seconds))
                 << " edits/s\n";
}

nlohmann::ordered_json times_json(std::uint64_t edits, const std::vector<double>& seconds) {
  return {{"seconds", seconds},
          {"median_seconds", median(seconds)},
          {"edits_per_second", rate(edits, median(seconds))}};
}

/// The measurements of all rounds.
struct Times {
  std::string world, file;  // id of the world in hex; its file
  std::vector<double> read_seconds, rebuild_seconds;
  ReplayReport report;  // of the last round
};

/// Reads the log once, then rebuilds the world once, from a store that is opened for this round:
/// nothing that a store keeps in memory speeds up the next round. The error is one line.
Result<void, std::string> run_round(const BenchOptions& options, Times& times) {
  const auto world = open_for_reading(options.common.world, options.at);
  if (!world) return failure(world.error());
  Store& store = *world->store;
  times.world = to_hex(store.meta().world_id);
  times.file = store.file();
  const bool is_first = times.read_seconds.empty();
  // Every round ends where the first one ended, even if a server appends edits meanwhile.
  const Sequence at = is_first ? world->end : times.report.seq;

  auto start = Clock::now();
  std::uint64_t counted = 0;
  const auto read = store.read_log(1, at, [&](const EditRecord&) {
    ++counted;
    return true;
  });
  times.read_seconds.push_back(seconds_since(start));
  if (!read) return failure(read.error().message());

  start = Clock::now();
  auto replayed = Replayer(store, *world->generator).run(at);
  times.rebuild_seconds.push_back(seconds_since(start));
  if (!replayed) return failure(replayed.error().message());
  times.report = *std::move(replayed);
  if (times.report.first) return failure(times.file + ": " + times.report.first->message());
  if (counted != times.report.edits && !is_first) {
    return failure(times.file + ": the log changed during the measurement");
  }
  return {};
}

}  // namespace

void declare_bench(SubcommandOptions& command_line, BenchOptions& options) {
  command_line.common(options.common, "folder of the world; a server may be running it");
  command_line.moment("--at", options.at, "end of the replay");
  command_line.number("--rounds", options.rounds, 1, 1'000, "number of rounds; default 5");
}

Result<int, std::string> run_bench(const BenchOptions& options, std::ostream& out) {
  Times times;
  {
    ProgressLine line("rounds timed", options.common.progress);
    for (std::uint64_t round = 0; round < options.rounds; ++round) {
      if (const auto done = run_round(options, times); !done) return failure(done.error());
      line.show(round + 1, options.rounds);
    }
  }
  const ReplayReport& report = times.report;
  const std::uint64_t edits = report.edits;
  row(out, "world") << times.world << "  " << times.file << '\n';
  row(out, "edits") << edits << ", up to sequence " << report.seq << "; " << report.digests.size()
                    << " chunks, " << report.voxels_changed << " voxels changed\n";
  row(out, "rounds") << options.rounds << "; medians (least to most)\n";
  print_times(out, "read", edits, times.read_seconds);
  print_times(out, "rebuild", edits, times.rebuild_seconds);
  row(out, "stacks") << report.stack_depths.text() << " (depth:count)\n";
  row(out, "digest") << to_hex(report.world_digest) << '\n';
  const nlohmann::ordered_json json = {{"world_id", times.world},
                                       {"seq", report.seq},
                                       {"edits", edits},
                                       {"chunks", report.digests.size()},
                                       {"voxels_changed", report.voxels_changed},
                                       {"read", times_json(edits, times.read_seconds)},
                                       {"rebuild", times_json(edits, times.rebuild_seconds)},
                                       {"stack_depths", report.stack_depths.text()},
                                       {"world_digest", to_hex(report.world_digest)}};
  const auto written = write_report(options.common.json, json.dump(1));
  if (!written) return failure(written.error());
  return kReplayEqual;
}

}  // namespace runstone
