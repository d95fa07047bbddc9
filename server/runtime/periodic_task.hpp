// PeriodicTask: runs a function on the world strand repeatedly. The interval counts from the end of
// one run to the start of the next one. Threads: start() may be called from any thread, stop() from
// the world strand.
#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <utility>

#include "server/runtime/world_strand.hpp"

namespace runstone {

class PeriodicTask {
 public:
  /// `strand` must outlive the object.
  PeriodicTask(WorldStrand& strand, std::chrono::milliseconds interval, std::function<void()> task)
      : strand_(strand), interval_(interval), task_(std::move(task)), timer_(strand.make_timer()) {}

  /// Starts the task, also after stop(). The first run comes one interval later. Requires that the
  /// task does not run.
  void start() {
    strand_.post([this] { schedule(++period_); });
  }
  /// Stops the task: no run starts after this call.
  void stop() {
    ++period_;
    timer_.cancel();
  }

 private:
  void schedule(std::uint64_t period) {
    if (period != period_) return;
    timer_.expires_after(interval_);
    strand_.wait(timer_, [this, period](const asio::error_code& error) {
      // The timer may have expired just before stop() cancelled it.
      if (error || period != period_) return;
      task_();
      schedule(period);
    });
  }

  WorldStrand& strand_;
  const std::chrono::milliseconds interval_;
  const std::function<void()> task_;
  asio::steady_timer timer_;
  std::uint64_t period_ = 0;  // begins with start(), ends with stop()
};

}  // namespace runstone
