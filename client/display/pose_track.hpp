// PoseTrack: the poses of another player in time. A server sends poses some ten times a second, and
// only if they changed. The track returns the pose of any moment, so that frames show a smooth
// movement: it shows the player a little late, between two poses that have arrived.
//   - The delay follows the time between poses and its variation, and changes gradually.
//   - Angles turn the shorter way.
//   - A pose far from the one before is a jump: the player is there at once.
//   - If the next pose is late, the movement goes on for kExtrapolateUs at most, and returns to the
//     last pose.
// Pure: times are arguments, in microseconds of one steady clock. One thread.
#pragma once
#include <array>
#include <cstddef>

#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

class PoseTrack {
 public:
  /// A pose that is farther from the one before is a jump.
  static constexpr double kJumpVoxels = 24;
  /// The shortest and the longest delay.
  static constexpr TimeUs kDelayUsMin = 30'000, kDelayUsMax = 400'000;
  /// A pause that is longer than this is no interval between poses: the player stood still.
  static constexpr TimeUs kPauseUs = 500'000;
  static constexpr TimeUs kExtrapolateUs = 100'000;
  /// The change of the delay, as a share of the time that passes.
  static constexpr double kDelayRate = 0.125;

  /// The first pose: the player is there at once.
  PoseTrack(const Pose& pose, TimeUs now_us);

  /// Takes a pose that arrived now. Requires that `now_us` does not decrease. Cost: O(1).
  void add(const Pose& pose, TimeUs now_us);
  /// Returns the pose to show now. Requires that `now_us` is not before the last add().
  Pose at(TimeUs now_us) const;
  /// Returns true if at() changes after `now_us` without another pose.
  bool is_moving(TimeUs now_us) const;
  /// Returns the pose that arrived last.
  const Pose& latest() const { return sample(count_ - 1).pose; }
  /// Returns the time by which at() is behind the arrival of poses.
  TimeUs delay_us(TimeUs now_us) const;

 private:
  struct Sample {
    TimeUs at_us = 0;
    Pose pose;
  };
  /// At the shortest interval of poses, more than the longest delay.
  static constexpr std::size_t kSamplesMax = 16;

  const Sample& sample(std::size_t i) const { return samples_[(first_ + i) % kSamplesMax]; }
  void push(const Sample& sample);
  void jump(const Pose& pose, TimeUs now_us);
  void measure(TimeUs interval_us);
  /// Returns the pose `late_us` after the last one, which continues the last movement.
  Pose extrapolated(TimeUs late_us) const;

  std::array<Sample, kSamplesMax> samples_{};  // a ring, ascending in time
  std::size_t first_ = 0, count_ = 0;          // count_ is at least 1
  double interval_us_ = 100'000;               // mean time between poses of a movement
  double deviation_us_ = 10'000;               // mean difference from it
  TimeUs delay_from_us_ = 0;                   // the delay at the last add()
  TimeUs delay_to_us_ = 0;                     // towards which it moves
};

/// Returns the pose at a share of the way from `a` (0) to `b` (1). Angles turn the shorter way.
Pose between(const Pose& a, const Pose& b, double share);

}  // namespace runstone
