#include "server/net/net_log.hpp"

#include <spdlog/spdlog.h>

#include <mutex>

#include "common/os/steady_clock.hpp"
#include "server/limits/line_throttle.hpp"

namespace runstone {

void log_broken_rule(SessionId session, const std::string& peer, GoodbyeReason reason,
                     const Error& error) {
  static std::mutex mutex;  // a leaf: guards the throttle
  static LineThrottle throttle;
  std::optional<std::uint64_t> left_out;
  {
    const std::lock_guard lock(mutex);
    left_out = throttle.take(steady_now_us());
  }
  if (!left_out) return;
  const auto logger = spdlog::get("net");
  if (logger == nullptr) return;
  logger->warn("session={} peer={} reason={} ({}) error=\"{}\" at={} left_out={}", session, peer,
               static_cast<unsigned>(reason), to_string(reason), error.what, error.offset,
               *left_out);
}

}  // namespace runstone
