// ViewPace: when the view of a player who moves follows. Every new view costs the server a walk over all of
// its chunks, so a player who crosses chunks faster than kViewEveryUs takes the view along in steps. The
// first step comes at once and the last one always comes: it is due until it is taken. Pure. One thread.
#pragma once
#include <optional>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"

namespace runstone {

inline constexpr TimeUs kViewEveryUs = 100'000;  // from step to step, at least

class ViewPace {
 public:
  /// Whether the view around `from` should move to `to` now; then the caller does so. Ask each turn.
  bool step(ChunkCoord from, ChunkCoord to, TimeUs now_us);

 private:
  std::optional<TimeUs> stepped_us_;
};

}  // namespace runstone
