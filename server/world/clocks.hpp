// Now: the two clocks of the server, read by the caller; the world strand itself reads none.
#pragma once
#include "common/core/ids.hpp"

namespace runstone {

struct Clocks {
  TimeUs steady_us = 0;  // monotonic: intervals, and what commits and pongs say
  TimeUs utc_us = 0;     // wall clock: what the log says
};

}  // namespace runstone
