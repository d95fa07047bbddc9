// VirtualTime: the only clock of the simulation. Events run in order of time, then of scheduling,
// so that one seed gives one history.
#pragma once
#include <cstdint>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "common/core/ids.hpp"

namespace runstone::test {

class VirtualTime {
 public:
  TimeUs now() const { return now_; }
  void after(TimeUs delay, std::function<void()> event) {
    events_.push({now_ + delay, next_++, std::move(event)});
  }
  /// Runs the next event. Returns false if there is none.
  bool step() {
    if (events_.empty()) return false;
    Event event = events_.top();
    events_.pop();
    now_ = event.at;
    event.run();
    return true;
  }
  void run_until(TimeUs end) {
    while (!events_.empty() && events_.top().at <= end) step();
    now_ = end;
  }

 private:
  struct Event {
    TimeUs at;
    std::uint64_t order;
    std::function<void()> run;
    bool operator<(const Event& other) const {  // the greatest element is at the top
      return at != other.at ? at > other.at : order > other.order;
    }
  };
  TimeUs now_ = 1'000'000;
  std::uint64_t next_ = 0;
  std::priority_queue<Event> events_;
};

}  // namespace runstone::test
