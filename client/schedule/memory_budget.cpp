#include "client/schedule/memory_budget.hpp"

#include <algorithm>

namespace runstone {
namespace {

/// Returns the number of chunks in a view with these radii.
std::size_t chunks_within(ViewRadii radii) {
  const std::int32_t h = radii.h;
  std::size_t columns = 0;
  for (std::int32_t x = -h; x <= h; ++x) {
    for (std::int32_t z = -h; z <= h; ++z) columns += x * x + z * z <= h * h ? 1 : 0;
  }
  return columns * (std::size_t{2} * radii.v + 1);
}

}  // namespace

MemoryBudget::MemoryBudget(std::size_t bytes_max, ViewRadii wanted)
    : bytes_max_(bytes_max), wanted_(wanted), level_(level_max()) {}

void MemoryBudget::set_wanted(ViewRadii wanted) {
  if (wanted == wanted_) return;
  wanted_ = wanted;
  level_ = level_max();
}

bool MemoryBudget::step(const MemoryUse& use, bool is_complete, TimeUs now_us) {
  peak_bytes_ = std::max(peak_bytes_, use.total());
  if (use.total() > bytes_max_) {
    if (level_ == 0) return false;
    --level_;
    ++shrinks_;
    if (grew_last_) pause_us_ = std::min(2 * pause_us_, kGrowPauseUsMax);
    grew_last_ = false;
    changed_us_ = now_us;
    return true;
  }
  if (!is_complete || !binds() || now_us - changed_us_ < pause_us_) return false;
  if (!should_fit(use, static_cast<std::uint8_t>(level_ + 1))) return false;
  ++level_;
  ++growths_;
  if (grew_last_) pause_us_ = kGrowPauseUs;  // the growth before has held
  grew_last_ = true;
  changed_us_ = now_us;
  return true;
}

ViewRadii MemoryBudget::radii_of(std::uint8_t level) const {
  const unsigned max = std::max<unsigned>(level_max(), 1);
  const auto scaled = [&](unsigned radius) {
    return static_cast<std::uint8_t>((radius * level + max / 2) / max);
  };
  return {scaled(wanted_.h), scaled(wanted_.v)};
}

bool MemoryBudget::should_fit(const MemoryUse& use, std::uint8_t level) const {
  const double growth = static_cast<double>(chunks_within(radii_of(level))) /
                        static_cast<double>(chunks_within(radii()));
  // A larger view has no more textures.
  const auto textures = static_cast<double>(use.textures);
  return (static_cast<double>(use.total()) - textures) * growth + textures <=
         static_cast<double>(bytes_max_);
}

}  // namespace runstone
