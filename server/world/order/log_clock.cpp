#include "server/world/order/log_clock.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "common/core/utc_text.hpp"

namespace runstone {
namespace {

constexpr TimeUs kMillion = 1'000'000;
// The time in a record may be any number. Times within this bound, some 70,000 years, can be added and
// subtracted.
constexpr TimeUs kSaneUs = TimeUs{1} << 61;

TimeUs within_bounds(TimeUs us) { return std::clamp(us, -kSaneUs, kSaneUs); }

/// Returns a - b, within the bounds.
TimeUs difference(TimeUs a, TimeUs b) { return within_bounds(within_bounds(a) - within_bounds(b)); }

}  // namespace

void LogClock::advance(const Clocks& now) {
  if (!steady_us_) return begin(now);
  if (now.steady_us < *steady_us_) return;  // the caller read the clocks before the last call
  const TimeUs passed_us = now.steady_us - *steady_us_;
  steady_us_ = now.steady_us;
  wall_us_ = within_bounds(now.utc_us);
  time_us_ += passed_us;
  const TimeUs error_us = difference(wall_us_, time_us_);
  if (std::abs(error_us) > kJumpUs) return jump(error_us, now);
  if (jump_) warning_ = "the wall clock agrees with the time of the log again";
  jump_.reset();
  slew(error_us, passed_us);
}

void LogClock::begin(const Clocks& now) {
  steady_us_ = now.steady_us;
  time_us_ = wall_us_ = within_bounds(now.utc_us);
  if (begin_us_) {
    time_us_ = within_bounds(*begin_us_);
    jump_ = Jump{difference(wall_us_, time_us_), now.steady_us};
  }
  ahead_us_ = std::max<TimeUs>(0, difference(last_us_, time_us_));
  warn_of_end_ahead();
}

void LogClock::warn_of_end_ahead() {
  if (difference(last_us_, time_us_) <= kJumpUs) return;
  warning_ =
      "the log ends at " + utc_text(last_us_) + ", but the wall clock reads " + utc_text(wall_us_) +
      ": until it has reached that time, edits get the time of the log's end. If the wall clock "
      "is right, the command `clock correct` ends that";
}

void LogClock::note_ordered(TimeUs time_us, bool is_correction) {
  if (is_correction) {
    last_us_ = time_us;
    ahead_us_ = 0;
    heard_.reset();
    // This server's clock may be as wrong as that of the one that ordered the record was.
    if (std::abs(difference(time_us_, time_us)) > kJumpUs) {
      time_us_ = within_bounds(time_us);
      jump_.reset();
    }
  }
  last_us_ = std::max(last_us_, time_us);
  ahead_us_ = std::max(ahead_us_, difference(last_us_, time_us_));
}

void LogClock::hear_owner(TimeUs time_us, const Clocks& now) {
  heard_ = Heard{time_us, now.steady_us};
}

void LogClock::take_over(const Clocks& now) {
  advance(now);
  const std::optional<Heard> heard = std::exchange(heard_, std::nullopt);
  if (heard) {
    const TimeUs owner_us = within_bounds(heard->time_us) + now.steady_us - heard->steady_us;
    if (difference(time_us_, owner_us) > kJumpUs) {
      time_us_ = owner_us;
      ahead_us_ = std::max<TimeUs>(0, difference(last_us_, time_us_));
      jump_.reset();
      const TimeUs error_us = difference(wall_us_, time_us_);
      if (std::abs(error_us) > kJumpUs) jump(error_us, now);
      return;
    }
  }
  warn_of_end_ahead();
}

TimeUs LogClock::time() const { return std::max(within_bounds(last_us_), time_us_ + ahead_us_); }

TimeUs LogClock::ahead_us() const { return difference(time(), wall_us_); }

bool LogClock::is_jump_kept() const { return jump_ && *steady_us_ - jump_->steady_us >= kAcceptUs; }

bool LogClock::is_step_due() const { return is_jump_kept() && ahead_us() < -kJumpUs; }

void LogClock::accept_wall_clock() {
  time_us_ = wall_us_;
  last_us_ = std::min(last_us_, wall_us_);
  ahead_us_ = 0;
  jump_.reset();
  heard_.reset();
}

void LogClock::slew(TimeUs error_us, TimeUs passed_us) {
  const TimeUs millionths = slew_left_ + passed_us * kSlewPpm;
  const TimeUs slew_max_us = millionths / kMillion;
  slew_left_ = millionths % kMillion;
  time_us_ += std::clamp(error_us, -slew_max_us, slew_max_us);
}

void LogClock::jump(TimeUs error_us, const Clocks& now) {
  if (!jump_ || std::abs(error_us - jump_->error_us) > kJumpUs) {
    jump_ = Jump{error_us, now.steady_us};
    warning_ = "the wall clock has jumped: it reads " + utc_text(wall_us_) +
               ", the time of the log is " + utc_text(time_us_) +
               ". Edits get the wall clock's time only if it keeps the jump for " +
               std::to_string(kAcceptUs / kJumpUs) + " minutes";
  } else if (is_jump_kept() && !is_step_due()) {
    warning_ = "the wall clock has kept its jump: the time of the log goes from " +
               utc_text(time_us_) + " to " + utc_text(wall_us_);
    if (wall_us_ < last_us_)
      *warning_ += ", but edits keep the time of the newest one until " + utc_text(last_us_) +
                   ". If the wall clock is right, the command `clock correct` ends that";
    ahead_us_ = std::max<TimeUs>(0, ahead_us());
    time_us_ = wall_us_;
    jump_.reset();
  }
}

TimeUs LogClock::stamp() {
  last_us_ = std::max(last_us_, time_us_);
  return last_us_;
}

}  // namespace runstone
