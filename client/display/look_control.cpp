#include "client/display/look_control.hpp"

#include <algorithm>
#include <cmath>

namespace runstone {

void LookControl::set_quality(std::optional<Quality> quality) {
  fixed_ = quality;
  count_ = 0;
  waited_ = 0;
}

FrameLook LookControl::look(TimeUs now_us) const {
  FrameLook out = look_;
  out.quality = fixed_.value_or(exact_ ? Quality::high : kLevels[level_].quality);
  if (!fixed_ && !exact_) out.scale = kLevels[level_].scale;
  out.exact = exact_;
  // The value repeats after an hour, so that a float holds it precisely.
  if (!exact_) out.seconds = static_cast<double>(now_us % 3'600'000'000) / 1e6;
  return out;
}

std::string LookControl::name() const {
  const FrameLook shown = look(0);
  const std::string quality = to_string(shown.quality);
  if (fixed_) return quality;
  const std::string automatic = "auto: " + quality;
  if (shown.scale == 1) return automatic;
  return automatic + " at " + std::to_string(std::lround(100 * shown.scale)) + " %";
}

void LookControl::frame_took(TimeUs us) {
  if (fixed_ || exact_) return;
  took_[count_++] = us;
  ++waited_;
  slow_ = us > 2 * kTargetUs ? slow_ + 1 : 0;
  const bool is_far_too_slow = slow_ == kSlowFrames;
  if (count_ < kFrames && !is_far_too_slow) return;
  const std::size_t frames = count_;
  count_ = 0;
  slow_ = 0;
  std::array<TimeUs, kFrames> sorted = took_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(frames / 2);
  std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(frames));
  const TimeUs median = *middle;
  if ((is_far_too_slow || median > kTargetUs) && level_ != 0) {
    if (came_from_below_) patience_ = std::min(2 * patience_, kPatienceMax);
    step_to(level_ - 1);
  } else if (!is_far_too_slow &&
             static_cast<double>(median) < kUpShare * static_cast<double>(kTargetUs) &&
             level_ + 1 != kLevels.size() && waited_ >= patience_) {
    step_to(level_ + 1);
  }
}

void LookControl::step_to(std::size_t level) {
  came_from_below_ = level > level_;
  level_ = level;
  waited_ = 0;
}

std::optional<Quality> parse_quality(std::string_view name) {
  for (const Quality quality : {Quality::low, Quality::medium, Quality::high}) {
    if (name == to_string(quality)) return quality;
  }
  return std::nullopt;
}

const char* to_string(Quality quality) {
  switch (quality) {
    case Quality::low:
      return "low";
    case Quality::medium:
      return "medium";
    case Quality::high:
      return "high";
  }
  return "unknown";
}

}  // namespace runstone
