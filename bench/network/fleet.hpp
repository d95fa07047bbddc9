// Fleet: bots in one place, all subscribed to the same chunks, with 2 edits a second each at fixed
// times. It is one runstone-bot program and its report.
#pragma once
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/network/sample_row.hpp"
#include "bench/network/testbed.hpp"

namespace runstone::bench {

inline constexpr double kFleetEditsPerSecond = 2;  // of each bot

/// The bots' measurements. No sample is dropped.
struct FleetReport {
  // The times from due to received and verified, over all subscribers.
  double p50_ms = 0, p90_ms = 0, p99_ms = 0, max_ms = 0;
  double samples = 0;
  // Edits that a bot of one place did not receive, of those that were not rejected. A bot may have
  // got a snapshot with the edit instead, or have left before. For several places it is 0.
  double never = 0;
  double due = 0;               // edits, of all bots together
  std::vector<SampleRow> rows;  // all samples except those that never arrived
  bool local_only = false;      // the report contains only the bots' own edits
  double disconnects = 0, rejected = 0;
  // Chunks whose voxels differ from the server's; broken rules of the protocol.
  double drifted = 0, violations = 0;
  double tiles = 0;           // received by the bots that only verify
  double bytes_received = 0;  // by all bots, from start to end
};

/// Reads a report of runstone-bot. Missing values are 0.
FleetReport fleet_report(const nlohmann::json& report);

struct FleetPlan {
  unsigned clients = 1;
  double seconds = 0;  // for which they edit
  double edits_per_second = kFleetEditsPerSecond;
  unsigned sites = 1;        // places where they build; clients of different ones see little of
                             // each other
  unsigned far_levels = 0;   // of tiles beyond the views
  bool has_replicas = true;  // some bots mesh and compare whole chunks; without, all bots verify
                             // what they receive
};

class Fleet {
 public:
  /// Starts the bots, and waits until all of them have the world.
  static Result<Fleet, std::string> join(Testbed& testbed, TestbedLink& link,
                                         const std::string& address, const FleetPlan& plan);
  double joined_s() const { return joined_s_; }
  Child& bots() { return *bots_; }
  /// Waits for the end of the bots. Broken rules are no error: they are part of the report.
  Result<FleetReport, std::string> finish(Testbed& testbed);

 private:
  FleetPlan plan_;
  std::unique_ptr<Child> bots_;
  std::string report_;
  double joined_s_ = 0;
};

}  // namespace runstone::bench
