#include "server/world/order/log_clock.hpp"

#include <algorithm>
#include <cstdlib>

#include "common/core/utc_text.hpp"

namespace runstone {
namespace {

constexpr TimeUs kMillion = 1'000'000;

}  // namespace

void LogClock::advance(const Clocks& now) {
  if (!steady_us_) return begin(now);
  if (now.steady_us < *steady_us_) return;  // the caller read the clocks before the last call
  const TimeUs passed_us = now.steady_us - *steady_us_;
  steady_us_ = now.steady_us;
  wall_us_ = now.utc_us;
  time_us_ += passed_us;
  const TimeUs error_us = now.utc_us - time_us_;
  if (std::abs(error_us) > kJumpUs) return jump(error_us, now);
  if (jump_) warning_ = "the wall clock agrees with the time of the log again";
  jump_.reset();
  slew(error_us, passed_us);
}

void LogClock::begin(const Clocks& now) {
  steady_us_ = now.steady_us;
  time_us_ = wall_us_ = now.utc_us;
  if (begin_us_) {
    time_us_ = *begin_us_;
    jump_ = Jump{now.utc_us - time_us_, now.steady_us};
  }
  ahead_us_ = std::max<TimeUs>(0, last_us_ - time_us_);
  if (last_us_ - time_us_ <= kJumpUs) return;
  warning_ =
      "the log ends at " + utc_text(last_us_) + ", but the wall clock reads " +
      utc_text(now.utc_us) +
      ": until it has reached that time, edits get the time of the log's end. If the wall clock "
      "is right, the command `clock correct` ends that";
}

void LogClock::follow(TimeUs time_us, bool is_correction) {
  if (is_correction) {
    last_us_ = time_us;
    ahead_us_ = 0;
    // This server's clock may be as wrong as that of the one that ordered the record was.
    if (std::abs(time_us_ - time_us) > kJumpUs) {
      time_us_ = time_us;
      jump_.reset();
    }
  }
  last_us_ = std::max(last_us_, time_us);
  ahead_us_ = std::max(ahead_us_, last_us_ - time_us_);
}

void LogClock::accept_wall_clock() {
  time_us_ = wall_us_;
  last_us_ = std::min(last_us_, wall_us_);
  ahead_us_ = 0;
  jump_.reset();
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
    warning_ = "the wall clock has jumped: it reads " + utc_text(now.utc_us) +
               ", the time of the log is " + utc_text(time_us_) +
               ". Edits get the wall clock's time only if it keeps the jump for " +
               std::to_string(kAcceptUs / kJumpUs) + " minutes";
  } else if (now.steady_us - jump_->steady_us >= kAcceptUs) {
    warning_ = "the wall clock has kept its jump: the time of the log goes from " +
               utc_text(time_us_) + " to " + utc_text(now.utc_us);
    if (now.utc_us < last_us_)
      *warning_ += ", but edits keep the time of the newest one until " + utc_text(last_us_) +
                   ". If the wall clock is right, the command `clock correct` ends that";
    ahead_us_ = std::max<TimeUs>(0, time() - now.utc_us);
    time_us_ = now.utc_us;
    jump_.reset();
  }
}

TimeUs LogClock::stamp() {
  last_us_ = std::max(last_us_, time_us_);
  return last_us_;
}

}  // namespace runstone
