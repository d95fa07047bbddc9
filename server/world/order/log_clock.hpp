// LogClock: the time of the edit log. The wall clock may be set to a wrong time and back, but a time
// in the log stays. The times of edits decrease only at a record that corrects the time
// (CorrectTime). So the log's time does not follow a jump of the wall clock at once:
//   - It begins with the wall clock, or with another time if the wall clock is doubtful then: that
//     is a jump, too (server/runtime/clock_check.hpp). From then on it advances with the steady
//     clock, and is slewed towards the wall clock by at most kSlewPpm.
//   - A wall clock that differs from it by more than kJumpUs has jumped. A jump is not slewed. If
//     the wall clock keeps it for kAcceptUs, the log's time becomes the wall clock's: a time
//     service may set a clock long after the start, and a suspended computer stops its steady
//     clock.
//   - time(), by which restrictions end, advances with the steady clock. It steps only if the caller
//     calls accept_wall_clock(). The caller does so at a record that moves the ends of restrictions by
//     the same step, or if there are no such ends. So a jump ahead waits for the caller
//     (is_step_due()).
//   - While the last edit of the log is ahead of the log's time, edits get the time of that edit
//     again. Their order is that of their sequences. time() advances from there nevertheless: a clock
//     that was ahead once must not make a mute of five seconds last for years.
//   - A server that takes the world over goes on from the time of the former owner. If its own wall
//     clock is ahead of that time, it has jumped.
// Each jump makes a warning for the operator, and so does a log that ends ahead of the wall clock.
// Pure: the times of both clocks are arguments. One thread.
#pragma once
#include <optional>
#include <string>
#include <utility>

#include "server/world/environment/clocks.hpp"

namespace runstone {

class LogClock {
 public:
  static constexpr TimeUs kJumpUs = 60'000'000;
  static constexpr TimeUs kAcceptUs = 60 * kJumpUs;
  static constexpr TimeUs kSlewPpm = 500;

  /// `last_us` is the time of the last edit in the log, or 0 if the log is empty. It may be any
  /// number. The log's time begins with `begin_us`, which is at least `last_us`; nullopt: with the
  /// wall clock.
  explicit LogClock(TimeUs last_us, std::optional<TimeUs> begin_us = std::nullopt)
      : last_us_(last_us), begin_us_(begin_us) {}

  /// Reads both clocks. A jump is noticed by the next call.
  void advance(const Clocks& now);
  /// Returns the time for an edit that is ordered at the last advance().
  TimeUs stamp();
  /// Reports an edit that another server has ordered at this time, now or earlier. `is_correction` is
  /// true if the record corrects the time.
  void note_ordered(TimeUs time_us, bool is_correction = false);
  /// Reports that the owner of the world has ordered an edit at this time just now.
  void hear_owner(TimeUs time_us, const Clocks& now);
  /// From now on this server orders the edits, because it has taken the world over.
  void take_over(const Clocks& now);
  /// Returns the log's time at the last advance(), or a later one if the log ends ahead of the wall
  /// clock: at least the time of the last edit, and always advancing with the steady clock.
  TimeUs time() const;
  /// Returns the wall clock at the last advance().
  TimeUs wall_us() const { return wall_us_; }
  /// Returns how far time() is ahead of the wall clock; below 0: how far it is behind.
  TimeUs ahead_us() const;
  /// Returns true if the wall clock has jumped ahead, and has kept the jump for kAcceptUs. Then the
  /// caller makes the log's time the wall clock's.
  bool is_step_due() const;
  /// Returns true if the wall clock has jumped, and has not kept the jump for kAcceptUs.
  bool has_jumped() const { return jump_.has_value() && !is_jump_kept(); }
  /// Makes the log's time that of the wall clock at the last advance(). If it was ahead, the
  /// next stamp() is for a record that corrects the time.
  void accept_wall_clock();
  /// Returns the newest warning that was not taken, if there is one.
  std::optional<std::string> take_warning() { return std::exchange(warning_, std::nullopt); }

 private:
  struct Jump {
    TimeUs error_us = 0;   // the wall clock minus the log's time
    TimeUs steady_us = 0;  // when the jump was noticed
  };
  struct Heard {
    TimeUs time_us = 0;    // of an edit that the owner had just ordered
    TimeUs steady_us = 0;  // when it arrived
  };

  void begin(const Clocks& now);
  void slew(TimeUs error_us, TimeUs passed_us);
  void jump(TimeUs error_us, const Clocks& now);
  bool is_jump_kept() const;
  void warn_of_end_ahead();

  TimeUs last_us_;                   // of the last edit
  std::optional<TimeUs> begin_us_;   // of the log's time, if it does not begin with the wall clock
  TimeUs wall_us_ = 0;               // the wall clock at steady_us_
  TimeUs time_us_ = 0;               // the log's time at steady_us_
  TimeUs ahead_us_ = 0;              // how far time() is ahead of time_us_
  std::optional<TimeUs> steady_us_;  // of the last advance(); nullopt before the first
  TimeUs slew_left_ = 0;             // millionths of 1 us of slew, below one million
  std::optional<Jump> jump_;         // a jump that the log's time does not follow
  std::optional<Heard> heard_;       // the last one of the present owner
  std::optional<std::string> warning_;
};

}  // namespace runstone
