// A server dies again and again, by kill -9 or by a power loss, while a builder builds, hostile
// clients attack, and the host changes rights, materials and names, rolls edits back and makes backups.
// After each death the world is compacted, and most compactions are cut. All connections use TLS. The
// tests check that the next server starts, that the log has every edit that was reported as durable
// exactly once, and that every change is there that was answered with exit code 0.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>

#include "tests/integration/server/app/dying_worlds.hpp"
#include "tests/integration/server/app/honest_builder.hpp"
#include "tests/integration/server/app/host_at_work.hpp"
#include "tests/integration/server/app/hostile_clients.hpp"
#include "tests/support/replay/run_replay.hpp"

namespace runstone::test {
namespace {

#ifdef RUNSTONE_SANITIZED
// With sanitizers, replays and compactions of thousands of chunks take minutes.
constexpr int kShortCycles = 3;
#else
constexpr int kShortCycles = 6;
#endif
constexpr int kKills = 500, kPowerLosses = 250;
// The worlds on a disk that ignores syncs, and the cycles of each. A loss that is found ends the test.
constexpr int kLyingDisks = 6, kLyingDiskCycles = 6;
// Another world is made after so many cycles, because each cycle adds about a megabyte.
constexpr int kCyclesPerWorld = 25;
constexpr int kCyclesPerLongOne = 4;
// In so many cycles something of each kind happens, on a slow machine as well.
constexpr int kManyCycles = 100;

struct CrashTally {
  int cycles = 0, failed_starts = 0;
  std::uint64_t durable = 0, mine = 0;  // edits reported as durable: all, and the builder's
  std::uint64_t hostile = 0;            // durable edits of all others
  std::uint64_t lost = 0, repeated = 0;
  std::uint64_t commands = 0, rollbacks = 0, backups = 0;  // answered with exit code 0
  std::uint64_t not_done = 0, cut = 0;                     // commands
  std::uint64_t missing = 0;                               // of what was answered
  std::array<std::uint64_t, 3> compactions{};              // by CompactionEnd
  std::string error;  // of the first log that could not be read, or of a backup
  void count(CompactionEnd end) { ++compactions[static_cast<std::size_t>(end)]; }
  std::uint64_t compacted(CompactionEnd end) const {
    return compactions[static_cast<std::size_t>(end)];
  }
  bool is_sound() const {
    return failed_starts == 0 && lost == 0 && repeated == 0 && missing == 0 && error.empty() &&
           compacted(CompactionEnd::failed) == 0;
  }
  std::string summary() const {
    std::ostringstream out;
    out << cycles << " cycles, " << durable << " durable edits, of them " << mine
        << " of the builder, " << hostile << " of others, " << lost << " lost, " << repeated
        << " repeated, " << failed_starts << " failed starts; " << commands
        << " changes of rights, materials and names, " << rollbacks << " rollbacks and " << backups
        << " backups answered, " << missing << " of them missing; " << not_done
        << " commands refused or not on disk in time, " << cut
        << " cut; compactions: " << compacted(CompactionEnd::done) << " done, "
        << compacted(CompactionEnd::cut) << " cut, " << compacted(CompactionEnd::failed)
        << " failed";
    return out.str();
  }
  void add(const HonestBuilder::Audit& audit) {
    lost += audit.lost;
    repeated += audit.repeated;
    mine += audit.mine;
    hostile += audit.others;
    if (error.empty()) error = audit.error;
  }
};

/// Starts a world a last time, stops it in order, and compares its snapshots with a replay.
template <class World>
void verify_world(World& world, const HostChanges& changes, CrashTally& tally) {
  if (world.start() == 0) {
    ++tally.failed_starts;
    return;
  }
  tally.missing += changes.missing();
  CHECK(world.stop());
  const ReplayOutcome outcome = run_replay({"verify", "--world", world.folder()});
  INFO(outcome.out << outcome.err);
  CHECK(outcome.code == 0);
}

/// Lets the servers of one world die `cycles` times, or until something is wrong. `is_verified`: the
/// world is verified afterwards.
template <class World>
void live_and_die(World& world, int cycles, bool is_verified, SplitMix64& random,
                  CrashTally& tally) {
  HonestBuilder builder;
  HostChanges changes(world.folder());
  GrieferRollbacks rollbacks(world.folder());
  LiveBackups backups(world.folder());
  for (int cycle = 0; cycle < cycles && tally.is_sound(); ++cycle) {
    const std::uint16_t port = world.start();
    if (port == 0) {
      ++tally.failed_starts;
      break;
    }
    tally.missing += changes.missing();
    {
      const HostileClients attackers(port, random.next());
      const HostAtWork host(port, changes, rollbacks, World::kHasFiles ? &backups : nullptr);
      builder.join(port);
      // A rollback may need longer than most cycles last.
      const int times = cycle % kCyclesPerLongOne == 0 ? 4 : 1;
      builder.build(times * std::chrono::milliseconds(random.between(50, 800)));
      world.die();
      builder.read_rest();
    }
    ++tally.cycles;
    tally.add(builder.audit(world.folder()));
    tally.missing += rollbacks.audit();
    if (!tally.is_sound()) break;
    tally.count(world.compact(random));
    tally.add(builder.audit(world.folder()));
  }
  if (is_verified && tally.is_sound()) verify_world(world, changes, tally);
  tally.durable += builder.durable();
  tally.commands += changes.answered();
  tally.rollbacks += rollbacks.answered();
  tally.backups += backups.done();
  tally.not_done += changes.not_done();
  tally.cut += changes.cut() + rollbacks.cut();
  tally.missing += backups.incomplete();
  if (tally.error.empty()) tally.error = backups.error();
}

template <class World>
void crash_cycles(const char* how, int cycles) {
  const auto begin = std::chrono::steady_clock::now();
  SplitMix64 random(static_cast<std::uint64_t>(cycles));
  CrashTally tally;
  while (tally.cycles < cycles && tally.is_sound()) {
    World world(random.next());
    live_and_die(world, std::min(cycles - tally.cycles, kCyclesPerWorld), true, random, tally);
    // A long test that somebody ends tells how far it came.
    if (cycles >= kManyCycles) std::cerr << how << ": " << tally.summary() << '\n';
  }
  const auto seconds =
      std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - begin);
  WARN(how << ": " << tally.summary() << ", " << seconds.count() << " s");
  INFO(tally.error);
  CHECK(tally.is_sound());
  CHECK(tally.mine > 0);
  CHECK(tally.hostile > 0);
  CHECK(tally.commands > 0);
  if (cycles < kManyCycles) return;
  CHECK(tally.rollbacks > 0);
  CHECK((tally.backups > 0 || !World::kHasFiles));
  CHECK(tally.compacted(CompactionEnd::done) > 0);
  CHECK(tally.compacted(CompactionEnd::cut) > 0);
}

/// Returns the number of cycles of a long test: that of the environment, if it has one.
int cycles_or(int usual) {
  const char* const text = std::getenv("RUNSTONE_TEST_CYCLES");
  return text == nullptr ? usual : std::atoi(text);
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

// These take up to an hour: docs/testing.md gives the command. The killed servers come first, because
// their process must have no second thread.
TEST_CASE("hundreds of killed servers lose no durable edit", "[.long]") {
  crash_cycles<KilledWorld>("kill -9", cycles_or(kKills));
}
TEST_CASE("hundreds of power losses lose no durable edit", "[.long]") {
  crash_cycles<PowerLossWorld>("power loss", cycles_or(kPowerLosses));
}

TEST_CASE("the power losses under attack are detected as losses if the disk ignores syncs",
          "[integration]") {
  SplitMix64 random(1);
  CrashTally tally;
  for (int n = 0; n < kLyingDisks && tally.is_sound(); ++n) {
    PowerLossWorld world(random.next());
    world.ignore_syncs();
    live_and_die(world, kLyingDiskCycles, false, random, tally);
  }
  WARN("no syncs: " << tally.summary() << (tally.error.empty() ? "" : ", a log cannot be read"));
  CHECK_FALSE(tally.is_sound());
}

}  // namespace runstone::test
