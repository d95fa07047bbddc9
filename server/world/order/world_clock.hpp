// WorldClock: the time of day of the world. A record of the log sets it (ClockEdit). From then on
// it runs with the steady clock, so that a wall clock that is wrong, late or set back does not move
// it. It stands still while no server runs the world: the store keeps how far it has come
// (SavedState::clock). Pure: times of the steady clock are arguments. Thread: one.
#pragma once
#include <optional>

#include "server/world/environment/saved_state.hpp"

namespace runstone {

class WorldClock {
 public:
  explicit WorldClock(const std::optional<SavedClock>& saved) {
    if (!saved) return;
    record_ = saved->record;
    set_ = saved->time;
  }

  /// Begins to run, unless it does. A clock that has not begun stands at the time of its start.
  void begin(TimeUs steady_us) {
    if (!since_us_) since_us_ = steady_us;
  }
  /// Sets the time, as the record of this sequence says.
  void set(const WorldTime& time, Sequence record, TimeUs steady_us) {
    record_ = record;
    correct(time, steady_us);
  }
  /// Takes the time that another server of the world has now.
  void correct(const WorldTime& time, TimeUs steady_us) {
    set_ = time;
    since_us_ = steady_us;
  }
  /// Returns the time at this moment, or nullopt if nobody has set the clock.
  std::optional<WorldTime> at(TimeUs steady_us) const {
    if (!set_) return std::nullopt;
    return since_us_ ? later(*set_, steady_us - *since_us_) : *set_;
  }
  /// Returns what the store keeps, so that the clock goes on with the time of this moment.
  std::optional<SavedClock> saved_at(TimeUs steady_us) const {
    const auto time = at(steady_us);
    return time ? std::optional(SavedClock{record_, *time}) : std::nullopt;
  }
  /// Returns the record that set the clock last, or 0.
  Sequence record() const { return record_; }
  bool is_set() const { return set_.has_value(); }

 private:
  Sequence record_ = 0;
  std::optional<WorldTime> set_;    // the time at since_us_
  std::optional<TimeUs> since_us_;  // steady clock
};

}  // namespace runstone
