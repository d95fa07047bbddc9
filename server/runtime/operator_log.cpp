#include "server/runtime/operator_log.hpp"

#include "server/runtime/log_payload.hpp"
#include "server/runtime/logging.hpp"

namespace runstone {
namespace {

/// Adds the number of lines that were left out before this one, if there are any.
std::string with_left_out(const std::string& line, std::uint64_t left_out) {
  return left_out == 0 ? line : with_field(line, "left_out", left_out);
}

}  // namespace

void OperatorLog::write(OperatorLogLevel level, const std::string& line, TimeUs now_us) {
  spdlog::logger& world = logger("world");
  switch (level) {
    case OperatorLogLevel::debug:
      world.debug("{}", line);
      break;
    case OperatorLogLevel::info:
      if (const auto left_out = infos_.take(now_us))
        world.info("{}", with_left_out(line, *left_out));
      break;
    case OperatorLogLevel::warn:
      if (const auto left_out = warnings_.take(now_us))
        world.warn("{}", with_left_out(line, *left_out));
      break;
    case OperatorLogLevel::error:
      world.error("{}", line);
      break;
  }
}

}  // namespace runstone
