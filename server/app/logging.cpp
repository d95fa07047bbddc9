#include "server/app/logging.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>

#include "common/core/assert.hpp"

namespace runstone {

void start_logging(const std::string& level) {
  const auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
  for (const char* module : {"world", "net", "store", "app"}) {
    auto found = spdlog::get(module);
    if (found == nullptr) {
      found = std::make_shared<spdlog::logger>(module, sink);
      found->set_pattern("%Y-%m-%dT%H:%M:%S.%e %^%l%$ %n: %v");
      spdlog::register_logger(found);
    }
    found->set_level(spdlog::level::from_str(level));
    found->flush_on(spdlog::level::info);
  }
}

spdlog::logger& logger(const char* module) {
  const auto found = spdlog::get(module);
  RUNSTONE_ASSERT(found != nullptr);
  return *found;  // the registry keeps it
}

}  // namespace runstone
