// ViewPace: when the view of a player who moves or turns follows. Every new view costs the server a walk over what is
// not sent yet, so a player who crosses chunks or turns round faster than kViewEveryUs takes the view along in steps,
// and looking about a little is no step. The first step comes at once and the last one always comes: it is due until
// it is taken. Pure. One thread.
#pragma once
#include <optional>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

inline constexpr TimeUs kViewEveryUs = 100'000;         // from step to step, at least
inline constexpr std::int32_t kViewTurn = 65'536 / 24;  // 15 degrees, in units of yaw
inline constexpr std::uint16_t kSightCone =
    65'536 / 8;  // half of what a player sees and will soon: 45 degrees

class ViewPace {
 public:
  /// Whether the view `from` should become `to` now; then the caller does so. Ask each turn.
  bool step(const View& from, const View& to, TimeUs now_us);

 private:
  std::optional<TimeUs> stepped_us_;
};

}  // namespace runstone
