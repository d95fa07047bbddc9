// OperatorLog: writes the lines of the world strand to the "world" logger. Lines at info and warn
// can be caused by peers, so each of these two levels has a LineThrottle.
// Threads: the world strand.
#pragma once
#include <string>

#include "server/limits/line_throttle.hpp"
#include "server/world/environment/world_environment.hpp"

namespace runstone {

class OperatorLog {
 public:
  void write(OperatorLogLevel level, const std::string& line, TimeUs now_us);

 private:
  LineThrottle infos_, warnings_;
};

}  // namespace runstone
