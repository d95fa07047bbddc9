// TcpRoom: how much TCP would send of a socket at once. What is handed to it beyond that waits in the kernel, where no
// edit can overtake it, until packets before it are acknowledged.
#pragma once
#include <cstddef>

#include "common/core/ids.hpp"

namespace runstone {

struct TcpRoom {
  std::size_t bytes = 0;     // whole packets
  TimeUs round_trip_us = 0;  // as TCP measures it; 0: not yet
};

/// Of a connected socket. Asks the kernel, some 1 us; where it does not answer there is room for everything.
/// While BBR measures the shortest round trip, 0.2 s of 10, its window is four packets (Cardwell et al., "BBR:
/// Congestion-Based Congestion Control", ACM Queue 14(5), 2016): edits alone need them, so there is room for one packet at
/// a time, if nothing else is on its way: its acknowledgement is what ends the measurement.
TcpRoom tcp_room(int socket);

}  // namespace runstone
