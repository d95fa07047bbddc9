#include "client/schedule/view_pace.hpp"

#include <cstdlib>

namespace runstone {
namespace {

bool has_turned(const View& from, const View& to) {
  if (from.cone != to.cone) return true;
  if (to.cone == 0) return false;
  const auto yaw = static_cast<std::int16_t>(
      static_cast<std::uint16_t>(to.yaw - from.yaw));  // the smaller of the two angles
  return std::abs(std::int32_t{yaw}) > kViewTurn ||
         std::abs(std::int32_t{to.pitch} - std::int32_t{from.pitch}) > kViewTurn;
}

}  // namespace

bool ViewPace::step(const View& from, const View& to, TimeUs now_us) {
  if (from.same_chunks(to) && !has_turned(from, to)) return false;
  if (stepped_us_ && now_us - *stepped_us_ < kViewEveryUs) return false;
  stepped_us_ = now_us;
  return true;
}

}  // namespace runstone
