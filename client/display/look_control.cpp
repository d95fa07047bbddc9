#include "client/display/look_control.hpp"

#include <algorithm>

namespace runstone {

void LookControl::set_quality(std::optional<Quality> quality) {
  fixed_ = quality;
  count_ = 0;
  waited_ = 0;
}

FrameLook LookControl::look(TimeUs now_us) const {
  FrameLook out = look_;
  out.quality = fixed_.value_or(exact_ ? Quality::high : automatic_);
  out.exact = exact_;
  // The value repeats after an hour, so that a float holds it precisely.
  if (!exact_) out.seconds = static_cast<double>(now_us % 3'600'000'000) / 1e6;
  return out;
}

std::string LookControl::name() const {
  const std::string level = to_string(look(0).quality);
  return fixed_ ? level : "auto: " + level;
}

void LookControl::frame_took(TimeUs us) {
  if (fixed_ || exact_) return;
  took_[count_++] = us;
  ++waited_;
  if (count_ < kFrames) return;
  count_ = 0;
  std::array<TimeUs, kFrames> sorted = took_;
  std::nth_element(sorted.begin(), sorted.begin() + kFrames / 2, sorted.end());
  const TimeUs median = sorted[kFrames / 2];
  if (median > kTargetUs && automatic_ != Quality::low) {
    if (came_from_below_) patience_ = std::min(2 * patience_, kPatienceMax);
    step(-1);
  } else if (static_cast<double>(median) < kUpShare * static_cast<double>(kTargetUs) &&
             automatic_ != Quality::high && waited_ >= patience_) {
    step(1);
  }
}

void LookControl::step(int levels) {
  automatic_ = static_cast<Quality>(static_cast<int>(automatic_) + levels);
  came_from_below_ = levels > 0;
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
