// TcpRoom: how many bytes TCP would send of a socket at once. Bytes beyond that wait in the kernel,
// where no edit can overtake them, until earlier packets are acknowledged.
#pragma once
#include <cstddef>

#include "common/core/ids.hpp"

namespace runstone {

struct TcpRoom {
  std::size_t bytes = 0;     // whole packets
  TimeUs round_trip_us = 0;  // as TCP measures it; 0: not yet
};

/// Returns the room of a connected socket, without a limit if the kernel does not know. Cost: about
/// 1 us. While BBR measures the shortest round trip, 0.2 s of every 10 s, its window is four
/// packets (Cardwell et al., "BBR: Congestion-Based Congestion Control", ACM Queue 14(5), 2016).
/// Edits need them. So there is room for one packet if none is in flight, because the measurement
/// ends with the acknowledgement of a packet.
TcpRoom tcp_room(int socket);

}  // namespace runstone
