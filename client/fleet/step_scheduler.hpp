// StepScheduler: who of many is to be stepped next, by the time it is due. Each has one turn at a time. One thread.
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
  struct Turn {
    TimeUs due_us = 0;
    std::size_t who = 0;
    friend auto operator<=>(const Turn&, const Turn&) = default;
  };
  void add(std::size_t who, TimeUs due_us) { turns_.push({due_us, who}); }
  /// All turns that were added come now: what each has to do may have changed.
  void hasten(TimeUs now_us) {
    std::vector<Turn> turns;
    for (; !turns_.empty(); turns_.pop())
      turns.push_back({std::min(turns_.top().due_us, now_us), turns_.top().who});
    turns_ = decltype(turns_)(std::greater<>(), std::move(turns));
  }
  /// The next turn that is due by now, taken out.
  std::optional<Turn> take(TimeUs now_us) {
    if (turns_.empty() || turns_.top().due_us > now_us) return std::nullopt;
    const Turn turn = turns_.top();
    turns_.pop();
    return turn;
  }
  std::optional<TimeUs> next_us() const {
    if (turns_.empty()) return std::nullopt;
    return turns_.top().due_us;
  }

 private:
  std::priority_queue<Turn, std::vector<Turn>, std::greater<>> turns_;
};

}  // namespace runstone
