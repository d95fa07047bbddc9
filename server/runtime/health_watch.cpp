#include "server/runtime/health_watch.hpp"

#include <asio/post.hpp>
#include <chrono>
#include <utility>

#include "common/os/steady_clock.hpp"

namespace runstone {
namespace {

constexpr std::chrono::seconds kMeasureInterval{5};

}  // namespace

HealthWatch::HealthWatch(WorldStrand& strand, asio::thread_pool& workers, std::string place)
    : strand_(strand),
      workers_(workers),
      place_(std::move(place)),
      started_us_(steady_now_us()),
      task_(strand, kMeasureInterval, [this] { measure(); }) {}

void HealthWatch::start() {
  strand_.post([this] { measure(); });
  task_.start();
}

void HealthWatch::measure() {
  // A disk that does not answer keeps one worker busy, not all of them.
  if (std::exchange(is_measuring_, true)) return;
  asio::post(workers_, [this] {
    strand_.post([this, usage = disk_usage_of(place_)] {
      usage_ = usage;
      is_measuring_ = false;
    });
  });
}

ServerHealth HealthWatch::health(std::optional<std::uint64_t> log_bytes) const {
  const TimeUs now_us = steady_now_us();
  return {now_us - started_us_, usage_.free_bytes, usage_.world_bytes,
          usage_.wal_bytes,     log_bytes,         lag_.lag_us(now_us)};
}

}  // namespace runstone
