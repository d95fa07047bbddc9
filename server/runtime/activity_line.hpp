// The log line that tells an operator what happened since the line before: "in 60 s: 2 players
// came, 1204 edits, 3 edits refused, 12.3 MB sent; now 4 players, 212.0 MB of world in memory". It
// names only what moved. The line of all counters is counters_line().
#pragma once
#include <cstdint>
#include <string>

#include "server/net/net_session.hpp"
#include "server/store/log_writer.hpp"
#include "server/world/world_server.hpp"

namespace runstone {

/// Counts since the start of the server.
struct ActivitySample {
  WorldCounters world;
  std::uint64_t malformed = 0, bytes_in = 0, bytes_out = 0;
  std::uint64_t snapshots = 0, keyframes = 0;  // written
};
/// Thread: the world strand.
ActivitySample sample_activity(const WorldServer& world, const NetCounters& net,
                               const LogWriter::Counters& log);

/// What is, at the end of the time that the line is about.
struct ActivityNow {
  std::size_t players = 0, world_bytes = 0;
};

/// Returns the line, or an empty string if nothing moved. `seconds`: between the two samples.
std::string activity_line(const ActivitySample& before, const ActivitySample& after,
                          const ActivityNow& now, std::uint64_t seconds);

}  // namespace runstone
