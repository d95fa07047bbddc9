// Dying worlds: worlds whose servers die, and whose compactions are cut, at random moments. The cause
// is a kill -9, or a loss of power of a disk in memory.
#pragma once
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <thread>

#include "common/core/hash.hpp"
#include "server/admin/compact_program.hpp"
#include "tests/integration/server/app/server_process.hpp"
#include "tests/support/sql/power_loss_vfs.hpp"

namespace runstone::test {

/// Returns the default limits and budgets. Snapshots are so frequent that crashes interrupt them.
inline ServerConfig attacked_config(const std::string& world) {
  ServerConfig config;
  config.world = world;
  config.listen = "127.0.0.1:0";
  config.log_level = LogLevel::error;
  config.snapshot_edits = 100;
  config.names_per_address = 0;  // the host claims many
  config.disk_reserve_mib = 0;   // the test also runs on a nearly full disk
  return config;
}

/// How a compaction ended.
enum class CompactionEnd { done, cut, failed };

/// Compacts a world that no server runs. The error is one line.
inline Result<void, std::string> compact_all(const std::string& folder, bool shrinks) {
  constexpr TimeUs kLaterUs = 2'000'000'000'000'000;  // than any edit
  std::ostringstream out;
  return compact_world({folder, 0, shrinks, false, true}, kLaterUs, out);
}
/// Prints why a compaction failed that nothing cut.
inline CompactionEnd failed_compaction(const std::string& why) {
  std::fprintf(stderr, "%s\n", why.c_str());
  return CompactionEnd::failed;
}
/// On average, one compaction of so many is not cut.
inline constexpr std::uint32_t kCompactionsPerWhole = 3;

/// A world whose servers are killed.
class KilledWorld {
 public:
  /// A backup reads the files while the server writes them.
  static constexpr bool kHasFiles = true;
  explicit KilledWorld(std::uint64_t /*seed*/) {}

  const std::string& folder() const { return folder_.path(); }
  /// Starts a server. Returns its port, or 0 if the start failed.
  std::uint16_t start() {
    process_.emplace([this] { return attacked_config(folder()); });
    if (process_->port() == 0) WARN(process_->failure());
    return process_->port();
  }
  void die() { process_->kill(); }
  /// Compacts the world in another process, which is killed at a random moment unless it ends before.
  /// Requires that this process has no second thread.
  CompactionEnd compact(SplitMix64& random) const {
    constexpr int kWholeMs = 120'000, kDoublingsMax = 12;
    const bool is_whole = random.below(kCompactionsPerWhole) == 0;
    const int ms_max = is_whole ? kWholeMs : 1 << random.below(kDoublingsMax);
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      const auto done = compact_all(folder(), true);
      if (!done) failed_compaction(done.error());
      ::_exit(done ? 0 : 1);
    }
    int status = 0;
    for (int ms = 0; ms < ms_max; ++ms) {
      if (::waitpid(child, &status, WNOHANG) == child) return end_of(status);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ::kill(child, SIGKILL);
    ::waitpid(child, &status, 0);
    return end_of(status);
  }
  /// Stops the server in order. Returns true if every edit is in the log.
  bool stop() { return process_->stop(); }

 private:
  static CompactionEnd end_of(int status) {
    if (WIFSIGNALED(status)) return CompactionEnd::cut;
    return WEXITSTATUS(status) == 0 ? CompactionEnd::done : CompactionEnd::failed;
  }

  TempFolder folder_;
  std::optional<ServerProcess> process_;
};

/// A world on a disk whose power fails. The disk is in memory.
class PowerLossWorld {
 public:
  static constexpr bool kHasFiles = false;

  explicit PowerLossWorld(std::uint64_t seed) : chance_(seed) {
    start_logging(LogLevel::error);
    // A server without power logs an error for each chunk that it wanted to read.
    for (const char* module : {"world", "store"}) logger(module).set_level(spdlog::level::off);
    vfs_.make_default();
    REQUIRE(open_or_create_world(folder(), flat_creation()).has_value());
    // The server looks for this file on the real disk, where it is empty.
    std::ofstream(folder_ / "world.sqlite") << "its content is in memory";
  }

  const std::string& folder() const { return folder_.path(); }
  std::uint16_t start() {
    auto server = Server::start(attacked_config(folder()), {});
    if (!server) {
      WARN(server.error());
      return 0;
    }
    server_ = *std::move(server);
    return server_->port();
  }
  /// The power fails during one of the next operations of the disk. The server cannot write any
  /// more, and its memory is lost.
  void die() {
    vfs_.cut_after(1 + chance_.below(kOperationsMax));
    server_->stop();
    server_.reset();
    vfs_.power_loss(chance_);
  }
  /// Compacts the world. The power fails during an operation of the disk, or when it is done.
  CompactionEnd compact(SplitMix64& random) {
    constexpr std::uint32_t kDoublingsMax = 14;
    const bool is_whole = random.below(kCompactionsPerWhole) == 0;
    if (!is_whole) vfs_.cut_after(1 + random.below(1U << random.below(kDoublingsMax)));
    const auto done = compact_all(folder(), false);
    const bool is_cut = vfs_.is_cut();
    vfs_.power_loss(chance_);
    if (is_cut) return CompactionEnd::cut;
    return done ? CompactionEnd::done : failed_compaction(done.error());
  }
  bool stop() {
    const bool is_durable = server_->stop().state.is_durable();
    server_.reset();
    return is_durable;
  }
  void ignore_syncs() { vfs_.ignore_syncs(); }

 private:
  static constexpr std::uint32_t kOperationsMax = 40;  // a few commits

  TempFolder folder_;
  SplitMix64 chance_;
  PowerLossVfs vfs_;
  std::unique_ptr<Server> server_;
};

}  // namespace runstone::test
