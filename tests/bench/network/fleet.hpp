// Crowd: bots in one place, all subscribed to the same chunks, each with 2 edits a second, open loop: one runstone-bot, and what
// it reports.
#pragma once
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tests/bench/network/lab.hpp"
#include "tests/bench/network/sample_row.hpp"

namespace runstone::bench {

inline constexpr double kFleetEditsPerSecond = 2;  // of each

/// What its bots saw. No sample is dropped.
struct FleetSight {
  double p50_ms = 0, p90_ms = 0, p99_ms = 0,
         max_ms = 0;  // due to received and verified, all subscribers
  double samples = 0, never = 0;
  std::vector<SampleRow> rows;  // of the samples but those that never came
  bool own_only = false;        // the bots' report knew only of own edits
  double disconnects = 0, rejected = 0;
  double drifted = 0,
         violations =
             0;  // chunks with other voxels than the server's; broken rules of the protocol
  double bytes_received = 0;  // by all of them, from start to end
};

/// From a report of runstone-bot; what it lacks is 0.
FleetSight sight_of(const nlohmann::json& report);

class Fleet {
 public:
  /// Starts so many bots that edit for so many seconds and waits until all of them see the world. `flags`: further ones of
  /// runstone-bot.
  static Result<Fleet, std::string> join(Lab& lab, LabLink& link, const std::string& address,
                                         unsigned clients, double seconds,
                                         const std::vector<std::string>& flags = {});
  double joined_s() const { return joined_s_; }
  Child& bots() { return *bots_; }
  /// Waits for their end. Broken rules are no error: they are part of what was seen.
  Result<FleetSight, std::string> finish(Lab& lab);

 private:
  std::unique_ptr<Child> bots_;
  std::string report_;
  double joined_s_ = 0;
};

}  // namespace runstone::bench
