// TimelinePlay: plays the log of the world from a moment to its end at a chosen speed. Pure: the
// passed time is an argument. One thread.
#pragma once
#include <optional>

#include "common/core/ids.hpp"

namespace runstone {

class TimelinePlay {
 public:
  /// Begins to play after the edit `from`.
  void start(Sequence from) {
    at_ = static_cast<double>(from);
    requested_.reset();
  }
  void stop() { at_.reset(); }
  bool is_playing() const { return at_.has_value(); }
  /// Returns the place that is played now, as a sequence with a fraction. Requires is_playing().
  double at() const { return *at_; }

  /// Goes on by `seconds`, at the speed at which the whole log takes `log_seconds`. `newest` is the
  /// last edit of the log, and `shown` the edit after which the world is shown. Returns the edit
  /// after which the world is to be shown now, or nullopt if it stays. Moments that come while
  /// another one loads are left out. Stops after the newest edit, which is the live world, and if
  /// the server has refused to show a moment.
  std::optional<Sequence> step(Sequence newest, Sequence shown, bool is_loading, double seconds,
                               double log_seconds);

 private:
  std::optional<double> at_;           // nullopt: nothing is played
  std::optional<Sequence> requested_;  // the last one since start()
};

}  // namespace runstone
