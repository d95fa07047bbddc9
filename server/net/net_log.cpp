#include "server/net/net_log.hpp"

#include <spdlog/spdlog.h>

#include <mutex>

#include "common/os/steady_clock.hpp"
#include "server/limits/line_throttle.hpp"

namespace runstone {

namespace {

class SharedThrottle {
 public:
  /// Returns how many lines were left out before this one, or nullopt if this one is to be left
  /// out.
  std::optional<std::uint64_t> take() {
    const std::lock_guard lock(mutex_);
    return throttle_.take(steady_now_us());
  }

 private:
  std::mutex mutex_;  // a leaf: guards the throttle
  LineThrottle throttle_;
};

}  // namespace

void log_failed_handshake(SessionId session, const std::string& peer, const std::string& why) {
  static SharedThrottle throttle;
  const auto left_out = throttle.take();
  const auto logger = left_out ? spdlog::get("net") : nullptr;
  if (logger == nullptr) return;
  logger->info("session={} peer={} handshake failed: {} left_out={}", session, peer, why,
               *left_out);
}

void log_refused_gateway(const std::string& why) {
  static SharedThrottle throttle;
  const auto left_out = throttle.take();
  const auto logger = left_out ? spdlog::get("net") : nullptr;
  if (logger == nullptr) return;
  logger->warn("a connection of the gateway was closed: {} left_out={}", why, *left_out);
}

void log_broken_rule(SessionId session, const std::string& peer, GoodbyeReason reason,
                     const Error& error) {
  static SharedThrottle throttle;
  const auto left_out = throttle.take();
  const auto logger = left_out ? spdlog::get("net") : nullptr;
  if (logger == nullptr) return;
  logger->warn("session={} peer={} reason={} ({}) error=\"{}\" at={} left_out={}", session, peer,
               static_cast<unsigned>(reason), to_string(reason), error.what, error.offset,
               *left_out);
}

}  // namespace runstone
