#include "server/net/net_log.hpp"

#include <spdlog/spdlog.h>

#include <mutex>
#include <utility>

#include "common/os/steady_clock.hpp"
#include "server/limits/token_bucket.hpp"

namespace runstone {

void log_broken_rule(SessionId session, const std::string& peer, GoodbyeReason reason,
                     const Error& error) {
  static std::mutex mutex;  // a leaf
  static TokenBucket lines(10, 10);
  static std::uint64_t left_out = 0;
  std::uint64_t missed = 0;
  {
    const std::lock_guard lock(mutex);
    if (!lines.take(1, steady_now_us())) {
      ++left_out;
      return;
    }
    missed = std::exchange(left_out, 0);
  }
  const auto logger = spdlog::get("net");
  if (logger == nullptr) return;
  logger->warn("session={} peer={} reason={} ({}) error=\"{}\" at={} left_out={}", session, peer,
               static_cast<unsigned>(reason), to_string(reason), error.what, error.offset, missed);
}

}  // namespace runstone
