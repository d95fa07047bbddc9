#include "client/display/pose_track.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

/// The weight of a new interval in the means, as that of the round trip in TCP.
constexpr double kMeanWeight = 0.125, kDeviationWeight = 0.25;

std::uint16_t turned(std::uint16_t from, std::uint16_t to, double share) {
  // The difference modulo a turn, as the nearer one of both directions.
  const auto way = static_cast<std::int16_t>(static_cast<std::uint16_t>(to - from));
  return static_cast<std::uint16_t>(from + std::lround(way * share));
}

double distance(const WorldPos& a, const WorldPos& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

double share_of(TimeUs at, TimeUs from, TimeUs to) {
  return static_cast<double>(at - from) / static_cast<double>(to - from);
}

}  // namespace

Pose between(const Pose& a, const Pose& b, double share) {
  const auto mix = [share](double from, double to) { return from + (to - from) * share; };
  Pose out;
  out.at = {mix(a.at.x, b.at.x), mix(a.at.y, b.at.y), mix(a.at.z, b.at.z)};
  out.yaw = turned(a.yaw, b.yaw, share);
  out.pitch = static_cast<std::int16_t>(std::clamp<long>(std::lround(mix(a.pitch, b.pitch)),
                                                         std::numeric_limits<std::int16_t>::min(),
                                                         std::numeric_limits<std::int16_t>::max()));
  return out;
}

PoseTrack::PoseTrack(const Pose& pose, TimeUs now_us) {
  jump(pose, now_us);
  delay_from_us_ = delay_to_us_ =
      static_cast<TimeUs>(std::lround(interval_us_ + 2 * deviation_us_));
}

void PoseTrack::jump(const Pose& pose, TimeUs now_us) {
  first_ = 0;
  count_ = 1;
  samples_[0] = {now_us, pose};
}

void PoseTrack::push(const Sample& sample) {
  if (count_ == kSamplesMax) {
    first_ = (first_ + 1) % kSamplesMax;
    --count_;
  }
  samples_[(first_ + count_) % kSamplesMax] = sample;
  ++count_;
}

void PoseTrack::measure(TimeUs interval_us) {
  const double off = std::abs(static_cast<double>(interval_us) - interval_us_);
  deviation_us_ += (off - deviation_us_) * kDeviationWeight;
  interval_us_ += (static_cast<double>(interval_us) - interval_us_) * kMeanWeight;
  const auto wanted = static_cast<TimeUs>(std::lround(interval_us_ + 2 * deviation_us_));
  delay_to_us_ = std::clamp(wanted, kDelayUsMin, kDelayUsMax);
}

void PoseTrack::add(const Pose& pose, TimeUs now_us) {
  const Sample last = sample(count_ - 1);
  RUNSTONE_ASSERT(now_us >= last.at_us);
  delay_from_us_ = delay_us(now_us);
  if (distance(last.pose.at, pose.at) > kJumpVoxels) return jump(pose, now_us);
  const TimeUs pause_us = now_us - last.at_us;
  if (pause_us == 0) {  // two poses arrived together: the newer one holds
    samples_[(first_ + count_ - 1) % kSamplesMax].pose = pose;
    return;
  }
  if (pause_us > kPauseUs) {
    // The player stood there until about an interval ago, and began to move then. The place that
    // is shown now must not change, so the movement does not begin before that moment.
    const auto interval_us = static_cast<TimeUs>(std::lround(interval_us_));
    push({now_us - std::min(interval_us, delay_from_us_), last.pose});
  } else {
    measure(pause_us);
  }
  push({now_us, pose});
}

TimeUs PoseTrack::delay_us(TimeUs now_us) const {
  const auto passed = static_cast<double>(now_us - sample(count_ - 1).at_us);
  const auto step = static_cast<TimeUs>(std::lround(passed * kDelayRate));
  return std::clamp(delay_to_us_, delay_from_us_ - step, delay_from_us_ + step);
}

Pose PoseTrack::at(TimeUs now_us) const {
  const TimeUs shown_us = now_us - delay_us(now_us);
  if (count_ == 1 || shown_us <= sample(0).at_us) return sample(0).pose;
  const Sample& last = sample(count_ - 1);
  if (shown_us >= last.at_us) return extrapolated(shown_us - last.at_us);
  std::size_t i = count_ - 1;
  while (sample(i - 1).at_us > shown_us) --i;
  const Sample &from = sample(i - 1), &to = sample(i);
  return between(from.pose, to.pose, share_of(shown_us, from.at_us, to.at_us));
}

Pose PoseTrack::extrapolated(TimeUs late_us) const {
  const Sample &before = sample(count_ - 2), &last = sample(count_ - 1);
  if (late_us >= kExtrapolateUs) return last.pose;
  // At first with the speed of the movement, then slower and back: the player has probably stopped.
  const double rest = 1 - static_cast<double>(late_us) / static_cast<double>(kExtrapolateUs);
  const double way_us = static_cast<double>(late_us) * rest * rest;
  return between(before.pose, last.pose,
                 1 + way_us / static_cast<double>(last.at_us - before.at_us));
}

bool PoseTrack::is_moving(TimeUs now_us) const {
  if (count_ == 1) return false;
  return now_us - delay_us(now_us) < sample(count_ - 1).at_us + kExtrapolateUs;
}

}  // namespace runstone
