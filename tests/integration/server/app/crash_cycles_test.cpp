// A server dies again and again, by kill -9 or by a power loss, while a builder builds and hostile
// clients attack. All connections use TLS. After each death the next server starts, and the log has
// every edit that was reported as durable exactly once.
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>

#include "tests/integration/server/app/honest_builder.hpp"
#include "tests/integration/server/app/hostile_clients.hpp"
#include "tests/integration/server/app/server_process.hpp"
#include "tests/support/replay/run_replay.hpp"
#include "tests/support/sql/power_loss_vfs.hpp"

namespace runstone::test {
namespace {

constexpr int kShortCycles = 6, kKills = 500, kPowerLosses = 250;
// Another world is made after so many cycles, because each cycle adds about a megabyte.
constexpr int kCyclesPerWorld = 25;

/// Returns the default limits and budgets. Snapshots are so frequent that crashes interrupt them.
ServerConfig attacked_config(const std::string& world) {
  ServerConfig config;
  config.world = world;
  config.listen = "127.0.0.1:0";
  config.log_level = LogLevel::error;
  config.snapshot_edits = 100;
  config.disk_reserve_mib = 0;  // the test also runs on a nearly full disk
  return config;
}

/// A world whose servers are killed.
class KilledWorld {
 public:
  explicit KilledWorld(std::uint64_t /*seed*/) {}

  const std::string& folder() const { return folder_.path(); }
  /// Starts a server. Returns its port, or 0 if the start failed.
  std::uint16_t start() {
    process_.emplace([this] { return attacked_config(folder()); });
    if (process_->port() == 0) WARN(process_->failure());
    return process_->port();
  }
  void die() { process_->kill(); }
  /// Stops the server in order. Returns true if every edit is in the log.
  bool stop() { return process_->stop(); }

 private:
  TempFolder folder_;
  std::optional<ServerProcess> process_;
};

/// A world on a disk whose power fails. The disk is in memory.
class PowerLossWorld {
 public:
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

struct CrashTally {
  int cycles = 0, failed_starts = 0;
  std::uint64_t durable = 0, mine = 0;  // edits reported as durable: all, and the builder's
  std::uint64_t hostile = 0;            // edits of the hostile clients in the log
  std::uint64_t lost = 0, repeated = 0;
  std::string error;  // the first log that could not be read
  bool is_sound() const {
    return failed_starts == 0 && lost == 0 && repeated == 0 && error.empty();
  }
  std::string summary() const {
    std::ostringstream out;
    out << cycles << " cycles, " << durable << " durable edits, of them " << mine
        << " of the builder, " << hostile << " hostile edits in the log, " << lost << " lost, "
        << repeated << " repeated, " << failed_starts << " failed starts";
    return out.str();
  }
};

/// Lets the servers of one world die `cycles` times, or until something is wrong.
template <class World>
void live_and_die(World& world, int cycles, SplitMix64& random, CrashTally& tally) {
  HonestBuilder builder;
  HonestBuilder::Audit audit;
  for (int cycle = 0; cycle < cycles && tally.is_sound(); ++cycle) {
    const std::uint16_t port = world.start();
    if (port == 0) {
      ++tally.failed_starts;
      break;
    }
    {
      const HostileClients attackers(port, random.next());
      builder.join(port);
      builder.build(std::chrono::milliseconds(random.between(50, 800)));
      world.die();
      builder.read_rest();
    }
    ++tally.cycles;
    audit = builder.audit(world.folder());
    tally.lost += audit.lost;
    tally.repeated += audit.repeated;
    tally.error = audit.error;
  }
  tally.durable += builder.durable();
  tally.mine += audit.mine;
  tally.hostile += audit.others;
}

/// Starts a world a last time, stops it in order, and compares its snapshots with a replay.
template <class World>
void verify_world(World& world, CrashTally& tally) {
  if (world.start() == 0) {
    ++tally.failed_starts;
    return;
  }
  CHECK(world.stop());
  const ReplayOutcome outcome = run_replay({"verify", "--world", world.folder()});
  INFO(outcome.out << outcome.err);
  CHECK(outcome.code == 0);
}

template <class World>
void crash_cycles(const char* how, int cycles) {
  const auto begin = std::chrono::steady_clock::now();
  SplitMix64 random(static_cast<std::uint64_t>(cycles));
  CrashTally tally;
  while (tally.cycles < cycles && tally.is_sound()) {
    World world(random.next());
    live_and_die(world, std::min(cycles - tally.cycles, kCyclesPerWorld), random, tally);
    if (tally.is_sound()) verify_world(world, tally);
  }
  const auto seconds =
      std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - begin);
  WARN(how << ": " << tally.summary() << ", " << seconds.count() << " s");
  CHECK(tally.error.empty());
  CHECK(tally.failed_starts == 0);
  CHECK(tally.lost == 0);
  CHECK(tally.repeated == 0);
  CHECK(tally.mine > 0);
  CHECK(tally.hostile > 0);
}

}  // namespace

TEST_CASE("a server that is killed again and again under attack loses no durable edit",
          "[integration]") {
  crash_cycles<KilledWorld>("kill -9", kShortCycles);
}

TEST_CASE("a server that loses power again and again under attack loses no durable edit",
          "[integration]") {
  crash_cycles<PowerLossWorld>("power loss", kShortCycles);
}

// Minutes: docs/testing.md gives the command. The killed servers come first, because their process
// must have no second thread.
TEST_CASE("hundreds of killed servers lose no durable edit", "[.long]") {
  crash_cycles<KilledWorld>("kill -9", kKills);
}
TEST_CASE("hundreds of power losses lose no durable edit", "[.long]") {
  crash_cycles<PowerLossWorld>("power loss", kPowerLosses);
}

TEST_CASE("the power losses under attack are detected as losses if the disk ignores syncs",
          "[integration]") {
  SplitMix64 random(1);
  CrashTally tally;
  for (int n = 0; n < kShortCycles && tally.is_sound(); ++n) {
    PowerLossWorld world(random.next());
    world.ignore_syncs();
    live_and_die(world, kShortCycles, random, tally);
  }
  WARN("no syncs: " << tally.summary() << (tally.error.empty() ? "" : ", a log cannot be read"));
  CHECK_FALSE(tally.is_sound());
}

}  // namespace runstone::test
