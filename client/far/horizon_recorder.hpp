// HorizonRecorder: records how soon a joining client has the distant ground of its view. Pure. One
// thread.
#pragma once
#include <optional>

#include "client/far/far_tiles.hpp"
#include "common/core/ids.hpp"

namespace runstone {

/// Times are counted from the start of the connection attempt.
struct HorizonReport {
  std::optional<TimeUs> coarse_us;  // every tile of the highest level is held
  std::optional<TimeUs> all_us;     // no tile of the view is missing, and all are meshed
};

class HorizonRecorder {
 public:
  /// Begins unless it has begun.
  void begin(TimeUs began_us) {
    if (!began_us_) began_us_ = began_us;
  }
  /// Returns true if it has begun and not all of the ground was there yet.
  bool is_open() const { return began_us_ && !report_.all_us; }
  /// Looks at the tiles. Requires is_open(). Cost: that of FarTiles::missing().
  void look(const FarTiles& tiles, bool is_meshed, TimeUs now_us);
  const HorizonReport& report() const { return report_; }

 private:
  std::optional<TimeUs> began_us_;
  HorizonReport report_;
};

}  // namespace runstone
