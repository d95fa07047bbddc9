// Clocks: the times of the server's two clocks. The caller reads them; the world strand reads no
// clock.
#pragma once
#include "common/core/ids.hpp"

namespace runstone {

struct Clocks {
  TimeUs steady_us = 0;  // monotonic: for intervals, commits and pongs
  TimeUs utc_us = 0;     // wall clock: for the log (LogClock)
};

}  // namespace runstone
