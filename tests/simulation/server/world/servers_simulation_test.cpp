// Several servers of one world, with faults of every kind (servers_simulation.hpp). Each protection
// is removed once: the simulation must find the harm.
#include <catch2/catch.hpp>

#include "tests/simulation/server/world/servers_simulation.hpp"

namespace runstone::test {
namespace {

constexpr std::uint64_t kSteps = 1'000;

/// Runs a simulation. Returns what it found, or an empty text.
std::string violation(ServersSimulation& simulation, std::uint64_t steps = kSteps) {
  try {
    simulation.run(steps);
    return simulation.check().text();
  } catch (const SimFault& fault) {
    return fault.what();
  }
}

/// Returns true if a violation is one of the log or of a replica. A world that stands still is
/// none.
bool is_harm(const std::string& found) {
  return !found.empty() && found.find("does not come to rest") == std::string::npos;
}

void run_seeds(std::uint64_t first, std::uint64_t count, std::uint64_t steps = kSteps) {
  ServersSimulation::Counts sum;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    CAPTURE(seed);
    ServersSimulation simulation(seed, sum);
    CHECK(violation(simulation, steps) == "");
  }
  CHECK(sum.owners > count);
  CHECK(sum.handovers > count / 2);
  CHECK(sum.edits > sum.steps / 4);
  CHECK(sum.unexplained <= 1 + sum.edits / 10'000);
  WARN(count << " seeds, " << sum.steps << " steps: " << sum.edits << " edits, " << sum.rejected
             << " rejected, " << sum.owners << " owners, " << sum.kills << " kills, " << sum.pauses
             << " pauses, " << sum.stops << " stops, " << sum.handovers << " handovers, "
             << sum.cuts << " cuts and " << sum.silences << " silences between servers, "
             << sum.database_cuts << " cuts and " << sum.database_restarts
             << " restarts of the database, " << sum.full_disks << " full disks, "
             << sum.clock_jumps << " clock jumps, " << sum.chunks << " chunks compared, "
             << sum.unexplained << " edits never explained");
}

TEST_CASE("servers of one world lose no durable edit and agree after faults of every kind",
          "[simulation][servers]") {
#ifdef RUNSTONE_SANITIZED
  run_seeds(1, 2, 500);
#else
  run_seeds(1, 10);
#endif
}

// Runs one seed, the number after --rng-seed, and prints what happens to the servers.
TEST_CASE("one seed, with what happens to its servers", "[.seed]") {
  ServersSimulation::Counts counts;
  ServersSimulation simulation(Catch::rngSeed(), counts, {.tells = true});
  CHECK(violation(simulation) == "");
}

// Minutes: docs/testing.md gives the command.
TEST_CASE("servers of one world agree after a million steps", "[.long]") {
  run_seeds(1'000, 1'000);
}

#ifndef RUNSTONE_SANITIZED  // it says something of the simulation, and not of the code under test
// A case of its own for each protection, so that each has its own time limit. Without the locked
// row there is harm only if the owner stands still between two moments of a transaction, so it does
// that more often.
TEMPLATE_TEST_CASE_SIG("without a protection, a simulation finds the harm", "[simulation][servers]",
                       ((Protection kWithout), kWithout), Protection::fence, Protection::locked_row,
                       Protection::expiry, Protection::renewal, Protection::owner_clock,
                       Protection::epoch, Protection::durable_last, Protection::watermarks,
                       Protection::resumed, Protection::head_epoch) {
  constexpr std::uint64_t kSeedsMax = 200;
  ServersOptions options{.without = kWithout, .owner_pauses = kWithout == Protection::locked_row};
  ServersSimulation::Counts counts;
  std::string found;
  std::uint64_t seed = 0;
  while (seed < kSeedsMax && !is_harm(found)) {
    ServersSimulation simulation(++seed, counts, options);
    found = violation(simulation);
  }
  CHECK(is_harm(found));
  WARN("seed " << seed << ": " << found);
  // With it, the same seed does no harm.
  options.without.reset();
  ServersSimulation whole(seed, counts, options);
  CHECK(violation(whole) == "");
}
#endif

}  // namespace
}  // namespace runstone::test
