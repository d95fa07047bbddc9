// ViewPace: decides when the view follows a player who moves or turns. For every new view the
// server visits all chunks that it has not sent. So the view moves at most once per kViewEveryUs,
// and a small turn of the player does not move it. The first step is due at once. The last step
// stays due until it is taken. Pure. One thread.
#pragma once
#include <optional>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// The least time between two steps.
inline constexpr TimeUs kViewEveryUs = 100'000;
/// 15 degrees, in units of yaw. A smaller turn is no step.
inline constexpr std::int32_t kViewTurn = 65'536 / 24;
/// Half the angle of the cone that a player sees or will see soon: 45 degrees.
inline constexpr std::uint16_t kSightCone = 65'536 / 8;

class ViewPace {
 public:
  /// Returns true if the caller must replace the view `from` by `to` now. Call it every iteration.
  bool step(const View& from, const View& to, TimeUs now_us);

 private:
  std::optional<TimeUs> stepped_us_;
};

}  // namespace runstone
