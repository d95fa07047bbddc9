// StepScheduler: a queue of the times at which the bots of a fleet are to be stepped. Each bot has
// at most one entry. One thread.
#pragma once
#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "common/core/ids.hpp"

namespace runstone {

class StepScheduler {
 public:
  struct Step {
    TimeUs due_us = 0;
    std::size_t bot = 0;  // index
    friend auto operator<=>(const Step&, const Step&) = default;
  };
  void add(std::size_t bot, TimeUs due_us) { steps_.push({due_us, bot}); }
  /// Makes every step due by `now_us`. Call it when a change gives all bots something to do.
  void bring_forward(TimeUs now_us) {
    std::vector<Step> steps;
    for (; !steps_.empty(); steps_.pop())
      steps.push_back({std::min(steps_.top().due_us, now_us), steps_.top().bot});
    steps_ = decltype(steps_)(std::greater<>(), std::move(steps));
  }
  /// Removes and returns the first step that is due by `now_us`, or nullopt if none is.
  std::optional<Step> take(TimeUs now_us) {
    if (steps_.empty() || steps_.top().due_us > now_us) return std::nullopt;
    const Step step = steps_.top();
    steps_.pop();
    return step;
  }
  /// Returns the time of the first step, or nullopt if there is none.
  std::optional<TimeUs> next_us() const {
    if (steps_.empty()) return std::nullopt;
    return steps_.top().due_us;
  }

 private:
  std::priority_queue<Step, std::vector<Step>, std::greater<>> steps_;
};

}  // namespace runstone
