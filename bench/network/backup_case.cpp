#include "bench/network/backup_case.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <utility>
#include <vector>

#include "bench/harness/statistics.hpp"
#include "bench/network/fleet.hpp"
#include "server/store/store.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::bench {
namespace {

namespace fs = std::filesystem;
using SteadyClock = std::chrono::steady_clock;

constexpr unsigned kBuilders = 50, kBuildersQuick = 5;
constexpr double kRatioMax = 1.3;      // the target
constexpr double kLookSeconds = 0.05;  // between two looks at backup and WAL
constexpr double kFirstBackupSeconds = 120;
constexpr std::size_t kSliceChunks = 256;  // of the chunks that fill a world
constexpr std::int32_t kFarAway = 10'000;  // chunks from the builders

struct Window {
  bool has_backup = false;
  FleetReport seen;
  double wal_max_mb = 0;
  std::vector<double> backups_s;  // of the backups that ended within the window
};

double seconds_since(SteadyClock::time_point begin) {
  return std::chrono::duration<double>(SteadyClock::now() - begin).count();
}

std::uint64_t bytes_of(const fs::path& file) {
  std::error_code ignored;
  const auto bytes = fs::file_size(file, ignored);
  return ignored ? 0 : bytes;
}

/// Adds base chunks far away from the spawn until the world has `bytes` bytes. Requires that the
/// world has no edit.
Done fill_world(const std::string& folder, std::uint64_t bytes, std::uint64_t seed) {
  auto store = open_world(folder, StoreAccess::read_write);
  if (!store) return failure(store.error().message());
  SplitMix64 rng(seed);
  const Extent cube = Extent::cube((*store)->meta().chunk_edge);
  std::vector<std::pair<ChunkKey, ChunkPtr>> slice(kSliceChunks);
  for (auto& [key, chunk] : slice) {
    Chunk made;
    made.voxels = test::random_chunk(rng, cube, test::random_order(rng), 20);
    made.digest = digest_of(made.voxels);
    chunk = std::make_shared<const Chunk>(std::move(made));
  }
  // The same chunks at other places: to make others takes longer than to write them.
  for (std::int32_t index = 0; bytes_of(folder + "/world.sqlite") < bytes;) {
    for (auto& [key, chunk] : slice) {
      key = {0, {kFarAway + index % 256, index / 65536, index / 256 % 256}};
      ++index;
    }
    if (const auto saved = (*store)->save_base(slice); !saved)
      return failure(saved.error().message());
  }
  return {};
}

class BackupRun {
 public:
  BackupRun(Testbed& testbed, TestbedLink& link)
      : testbed_(testbed),
        options_(testbed.options()),
        link_(link),
        world_(testbed.fresh("world")),
        builders_(options_.quick ? kBuildersQuick : kBuilders) {}

  Result<std::vector<Window>, std::string> run() {
    if (auto made = make_world(); !made) return failure(made.error());
    auto server = testbed_.start_server(link_, world_, flags());
    if (!server) return failure(server.error());
    std::vector<Window> out;
    for (unsigned i = 0; i < 2 * options_.backup_rounds; ++i) {
      auto window = play(server->address, i % 2 == 1);
      if (!window) return failure(window.error());
      fmt::print(testbed_.progress(), "backup: window {} of {}, {}: p99 {} ms\n", i + 1,
                 2 * options_.backup_rounds, window->has_backup ? "backups" : "quiet",
                 number_text(window->seen.p99_ms));
      testbed_.progress().flush();
      out.push_back(*std::move(window));
    }
    if (auto ended = testbed_.stop_server(*server); !ended) return failure(ended.error());
    return out;
  }
  unsigned builders() const { return builders_; }
  double world_mb() const { return static_cast<double>(bytes_of(world_ + "/world.sqlite")) / 1e6; }

 private:
  std::vector<std::string> flags() const {
    return without_player_limits({"--generator", "terrain", "--seed", "7", "--sessions-max", "128",
                                  "--handshakes-per-address", "128"});
  }

  Done make_world() {
    // A new world with an operator gets no record of an invite for its first administrator, which
    // would be its first edit.
    std::vector<std::string> first = flags();
    first.insert(first.end(), {"--operators", std::string(2 * kPublicKeyBytes, '1')});
    auto server = testbed_.start_server(link_, world_, first);
    if (!server) return failure(server.error());
    if (auto ended = testbed_.stop_server(*server); !ended) return ended;
    return fill_world(world_, std::uint64_t{options_.backup_mib} << 20, options_.seed);
  }

  Result<Window, std::string> play(const std::string& address, bool has_backup) {
    const double seconds = options_.fleet_seconds;
    auto fleet = Fleet::join(testbed_, link_, address,
                             {.clients = builders_, .seconds = seconds, .has_replicas = false});
    if (!fleet) return failure(fleet.error());
    Window window;
    window.has_backup = has_backup;
    std::unique_ptr<Child> backup;
    std::string target;
    auto backup_begun = SteadyClock::now();
    // On a slow machine the first backup may end after the builders.
    const auto begun = SteadyClock::now();
    const auto lasts = [&] {
      const bool waits = has_backup && window.backups_s.empty();
      return seconds_since(begun) < (waits ? kFirstBackupSeconds : seconds);
    };
    while (lasts()) {
      if (has_backup && !backup) {
        target = testbed_.fresh("backup");
        backup_begun = SteadyClock::now();
        auto started = testbed_.start_client(link_, "runstone-server",
                                             {"backup", "--world", world_, "--to", target});
        if (!started) return failure(started.error());
        backup = *std::move(started);
      }
      if (!pause_for(kLookSeconds)) return failure("interrupted");
      window.wal_max_mb = std::max(
          window.wal_max_mb, static_cast<double>(bytes_of(world_ + "/world.sqlite-wal")) / 1e6);
      if (!backup || !backup->wait(0)) continue;
      if (!fs::exists(target)) return failure(backup->explain("made no backup"));
      window.backups_s.push_back(seconds_since(backup_begun));
      backup.reset();
      fs::remove_all(target);
    }
    backup.reset();  // kills the one in progress
    fs::remove_all(target + ".partial");
    auto seen = fleet->finish(testbed_);
    if (!seen) return failure(seen.error());
    window.seen = *std::move(seen);
    return window;
  }

  Testbed& testbed_;
  const NetOptions& options_;
  TestbedLink& link_;
  const std::string world_;
  const unsigned builders_;
};

double median_p99(const std::vector<Window>& windows, bool has_backup) {
  std::vector<double> values;
  for (const Window& window : windows) {
    if (window.has_backup == has_backup) values.push_back(window.seen.p99_ms);
  }
  return median(values);
}

}  // namespace

Done measure_backup(Testbed& testbed, NetFindings& findings) {
  auto link = testbed.make_link(test::link_profiles().front());
  if (!link) return failure(link.error());
  BackupRun run(testbed, **link);
  const auto windows = run.run();
  if (!windows) return failure("backup: " + windows.error());
  findings.tables += fmt::format(
      "\n### Backups\n\n"
      "{} builders in one place on loopback, {} edits a second each, windows of {} s; a world of "
      "{:.0f} MB, backed up again and again in every second window.\n\n"
      "| window | p50, p90, p99, max ms | backups, s each | WAL, largest, MB | disconnects |\n"
      "|---|---|---|---|---|\n",
      run.builders(), kFleetEditsPerSecond, testbed.options().fleet_seconds, run.world_mb());
  std::vector<double> backups_s;
  double wal_max_mb = 0;
  for (std::size_t i = 0; i < windows->size(); ++i) {
    const Window& window = (*windows)[i];
    const auto add = [&](std::string name, double value) {
      findings.figures.push_back({"backup", "loopback", "loopback",
                                  fmt::format("{} {}", i, window.has_backup ? "backups" : "quiet"),
                                  std::move(name), value});
    };
    add("seen_p50_ms", window.seen.p50_ms);
    add("seen_p99_ms", window.seen.p99_ms);
    add("samples", window.seen.samples);
    add("disconnects", window.seen.disconnects);
    add("violations", window.seen.violations);
    add("backups", static_cast<double>(window.backups_s.size()));
    add("wal_max_mb", window.wal_max_mb);
    backups_s.insert(backups_s.end(), window.backups_s.begin(), window.backups_s.end());
    wal_max_mb = std::max(wal_max_mb, window.wal_max_mb);
    fmt::format_to(std::back_inserter(findings.tables),
                   "| {} | {}, {}, {}, {} | {}{} | {} | {:.0f} |\n",
                   window.has_backup ? "backups" : "quiet", number_text(window.seen.p50_ms),
                   number_text(window.seen.p90_ms), number_text(window.seen.p99_ms),
                   number_text(window.seen.max_ms), window.backups_s.size(),
                   window.backups_s.empty() ? "" : ", " + number_text(median(window.backups_s)),
                   number_text(window.wal_max_mb), window.seen.disconnects);
  }
  const double quiet = median_p99(*windows, false), busy = median_p99(*windows, true);
  findings.targets.push_back(
      {fmt::format("edits during a backup of {:.0f} MB, {} builders: p99, median of {} windows",
                   run.world_mb(), run.builders(), testbed.options().backup_rounds),
       fmt::format("{} times that without", kRatioMax),
       fmt::format("{:.2f} times: {} ms, {} ms without", busy / quiet, number_text(busy),
                   number_text(quiet)),
       busy <= kRatioMax * quiet ? Verdict::met : Verdict::missed});
  return {};
}

}  // namespace runstone::bench
