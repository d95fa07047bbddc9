#include "server/runtime/world_log.hpp"

#include "server/runtime/logging.hpp"

namespace runstone {

void WorldLog::write(WorldLogLevel level, const std::string& line, TimeUs now_us) {
  spdlog::logger& world = logger("world");
  switch (level) {
    case WorldLogLevel::debug:
      world.debug("{}", line);
      break;
    case WorldLogLevel::info:
      if (const auto left_out = infos_.take(now_us)) world.info("{} left_out={}", line, *left_out);
      break;
    case WorldLogLevel::warn:
      if (const auto left_out = warnings_.take(now_us))
        world.warn("{} left_out={}", line, *left_out);
      break;
    case WorldLogLevel::error:
      world.error("{}", line);
      break;
  }
}

}  // namespace runstone
