// FarBudget: bounds the memory of tiles and their meshes. If they take more than the budget, the
// view loses its highest level: the client sees half as far, and nothing near changes. If all tiles
// of the view were meshed and one more level should fit, the view gets it again. The estimate
// assumes that all levels are equal. If it was wrong, the pause before the next attempt doubles.
// The budget may be exceeded by what arrives between two calls of step(). Pure. One thread.
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/core/ids.hpp"

namespace runstone {

class FarBudget {
 public:
  /// The least time between a change and the next growth. It doubles up to the maximum while
  /// growths fail.
  static constexpr TimeUs kGrowPauseUs = 2'000'000;
  static constexpr TimeUs kGrowPauseUsMax = 128'000'000;

  FarBudget(std::size_t bytes_max, std::uint8_t levels_wanted)
      : bytes_max_(bytes_max), wanted_(levels_wanted), levels_(levels_wanted) {}

  /// Sets the levels that are wanted. If the number is new, the view has this number again.
  void set_wanted(std::uint8_t levels);
  /// Compares the use with the budget, and changes the levels by one at most. `is_complete`: no
  /// tile has arrived for a while, and all were meshed. Returns true if levels() changed.
  bool step(std::size_t bytes, bool is_complete, TimeUs now_us);

  /// Returns View::levels.
  std::uint8_t levels() const { return levels_; }
  std::uint8_t wanted() const { return wanted_; }
  /// Returns true if the view has fewer levels than wanted.
  bool binds() const { return levels_ < wanted_; }
  std::size_t bytes_max() const { return bytes_max_; }

 private:
  const std::size_t bytes_max_;
  std::uint8_t wanted_, levels_;
  TimeUs changed_us_ = 0;
  TimeUs pause_us_ = kGrowPauseUs;
  bool grew_last_ = false;  // the last change was a growth
};

}  // namespace runstone
