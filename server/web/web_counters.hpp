// WebCounters: what the gateway counts of itself. Thread: the gateway's.
#pragma once
#include <cstdint>

namespace runstone {

struct WebCounters {
  std::uint64_t connections = 0;       // accepted since the start
  std::uint64_t refused = 0;           // new connections closed because of a limit
  std::uint64_t evicted = 0;           // older connections closed to make room for newer ones
  std::uint64_t connections_open = 0;  // now, in any state
  std::uint64_t accepts_failed = 0;    // the system gave no socket to a connection
  std::uint64_t requests = 0;          // answered, without those that became WebSockets
  std::uint64_t websockets = 0;        // opened since the start
  std::uint64_t websockets_open = 0;   // now
  std::uint64_t links_failed = 0;      // WebSockets that got no connection to their server
  std::uint64_t rules_broken = 0;      // WebSockets that were closed because of what they sent
  std::uint64_t frames_in = 0;         // from browsers
  std::uint64_t frames_out = 0;        // to browsers
  std::uint64_t bytes_in = 0;          // of these frames
  std::uint64_t bytes_out = 0;
  std::uint64_t map_requests = 0;          // requests that were queued to be drawn
  std::uint64_t map_refused = 0;           // because of a limit of their address
  std::uint64_t map_not_modified = 0;      // answered with 304
  std::uint64_t map_work_us = 0;           // time of the threads that draw
  std::uint64_t certificate_ends_s = 0;    // UTC since 1970; 0: there is none
  std::uint64_t certificates_read = 0;     // that replaced the first one
  std::uint64_t certificates_refused = 0;  // new ones that could not be used
  // These are measured when a page shows them.
  std::uint64_t memory_bytes = 0;       // of the process, in RAM
  std::uint64_t map_cache_bytes = 0;    // of what the map has drawn
  std::uint64_t log_lines_dropped = 0;  // lines of the log that could not be written
};

}  // namespace runstone
