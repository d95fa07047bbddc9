// The costs of an edit at two servers of one world, without sockets, encryption and database: what
// the world strand of each server takes, and the codec of the messages between them.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "bench/harness/bench_options.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// Processor time of an edit in microseconds: medians of the repetitions.
struct RelayRow {
  std::size_t commit_edits = 0;   // edits of each commit
  double owner_local_us = 0;      // at the owner: an edit of a player there
  double owner_relayed_us = 0;    // at the owner: an edit of a player at the other server
  double follower_local_us = 0;   // at the other server: an edit of a player there
  double follower_remote_us = 0;  // at the other server: an edit of a player at the owner
};

/// In a world of terrain of edge 32, 20 players at each of two servers stand in one place and see 6
/// chunks around. The two places are far apart. A repetition is 10,000 single voxels of the players
/// at one server, then 10,000 at the other one.
Result<std::vector<RelayRow>, std::string> run_relay_bench(const BenchOptions& options,
                                                           std::ostream& progress);

void write_table(const std::vector<RelayRow>& rows, std::ostream& out);
void write_json(const std::vector<RelayRow>& rows, std::ostream& out);

}  // namespace runstone::bench
