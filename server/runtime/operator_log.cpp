#include "server/runtime/operator_log.hpp"

#include "server/runtime/logging.hpp"

namespace runstone {

void OperatorLog::write(OperatorLogLevel level, const std::string& line, TimeUs now_us) {
  spdlog::logger& world = logger("world");
  switch (level) {
    case OperatorLogLevel::debug:
      world.debug("{}", line);
      break;
    case OperatorLogLevel::info:
      if (const auto left_out = infos_.take(now_us)) world.info("{} left_out={}", line, *left_out);
      break;
    case OperatorLogLevel::warn:
      if (const auto left_out = warnings_.take(now_us))
        world.warn("{} left_out={}", line, *left_out);
      break;
    case OperatorLogLevel::error:
      world.error("{}", line);
      break;
  }
}

}  // namespace runstone
