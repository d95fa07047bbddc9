#include "server/replay/replay_bench.hpp"

#include <algorithm>
#include <chrono>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <ostream>
#include <vector>

#include "common/core/hex.hpp"
#include "common/os/progress_line.hpp"
#include "common/os/steady_clock.hpp"
#include "server/replay/digest_list.hpp"
#include "server/replay/replay.hpp"
#include "server/store/world_folder.hpp"

namespace runstone {
namespace {

using Clock = std::chrono::steady_clock;

Unexpected<std::string> failure(std::string line) { return {std::move(line)}; }

/// Of an even number the mean of the two in the middle. Requires one at least.
double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

double rate(std::uint64_t edits, double seconds) {
  return seconds > 0 ? static_cast<double>(edits) / seconds : 0;
}

std::ostream& row(std::ostream& out, const char* name) {
  return out << std::left << std::setw(12) << name << std::right;
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

}  // namespace

Result<void, std::string> bench_replay(const ReplayOptions& options, std::ostream& out) {
  std::vector<double> read_seconds, rebuild_seconds;
  std::uint64_t edits = 0;
  ReplayReport report;
  std::string world, file;
  ProgressLine line("rounds timed", options.progress);
  for (std::uint32_t round = 0; round < options.rounds; ++round) {
    // Anew each time: what a store keeps in memory is not to count for the next round.
    const auto store = open_world(options.world, StoreAccess::read_only);
    if (!store) return failure(store.error().message());
    const auto generator = generator_of(**store);
    if (!generator) return failure(generator.error());
    world = to_hex((*store)->meta().world_id);
    file = (*store)->file();

    auto start = Clock::now();
    std::uint64_t counted = 0;
    // To the same end in every round, if a server is writing meanwhile.
    const Sequence at = round == 0 ? options.at : report.seq;
    const auto read = (*store)->read_log(1, at, [&](const EditRecord&) {
      ++counted;
      return true;
    });
    read_seconds.push_back(seconds_since(start));
    if (!read) return failure(read.error().message());

    start = Clock::now();
    auto replayed = Replayer(**store, **generator).run(at);
    rebuild_seconds.push_back(seconds_since(start));
    if (!replayed) return failure(replayed.error().message());
    report = *std::move(replayed);
    edits = report.edits;
    if (report.first) return failure(file + ": " + report.first->message());
    if (counted != edits && round != 0) return failure(file + ": the log changed meanwhile");
    line.show(round + 1, options.rounds);
  }
  row(out, "world") << world << "  " << file << '\n';
  row(out, "edits") << edits << ", up to sequence " << report.seq << "; " << report.digests.size()
                    << " chunks, " << report.voxels_changed << " voxels changed\n";
  row(out, "rounds") << options.rounds << "; medians (least to most)\n";
  print_times(out, "read", edits, read_seconds);
  print_times(out, "rebuild", edits, rebuild_seconds);
  row(out, "stacks") << report.stack_depths.text() << " (depth:count)\n";
  row(out, "digest") << to_hex(report.world_digest) << '\n';
  if (options.json.empty()) return {};
  const nlohmann::ordered_json json = {{"world_id", world},
                                       {"seq", report.seq},
                                       {"edits", edits},
                                       {"chunks", report.digests.size()},
                                       {"voxels_changed", report.voxels_changed},
                                       {"read", times_json(edits, read_seconds)},
                                       {"rebuild", times_json(edits, rebuild_seconds)},
                                       {"stack_depths", report.stack_depths.text()},
                                       {"world_digest", to_hex(report.world_digest)}};
  const auto written = write_text_file(options.json, json.dump(1) + "\n");
  if (!written) return failure(written.error().message());
  return {};
}

}  // namespace runstone
