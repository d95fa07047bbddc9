#include "client/far/far_budget.hpp"

#include <algorithm>

namespace runstone {

void FarBudget::set_wanted(std::uint8_t levels) {
  if (levels == wanted_) return;
  wanted_ = levels_ = levels;
}

bool FarBudget::step(std::size_t bytes, bool is_complete, TimeUs now_us) {
  if (bytes > bytes_max_) {
    if (levels_ == 0) return false;
    --levels_;
    if (grew_last_) pause_us_ = std::min(2 * pause_us_, kGrowPauseUsMax);
    grew_last_ = false;
    changed_us_ = now_us;
    return true;
  }
  if (!is_complete || !binds() || now_us - changed_us_ < pause_us_) return false;
  const std::size_t levels = std::max<std::size_t>(levels_, 1);
  if (bytes / levels * (levels_ + std::size_t{1}) > bytes_max_) return false;
  ++levels_;
  if (grew_last_) pause_us_ = kGrowPauseUs;  // the growth before has held
  grew_last_ = true;
  changed_us_ = now_us;
  return true;
}

}  // namespace runstone
