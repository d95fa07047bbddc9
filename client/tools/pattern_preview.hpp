// PatternPreview: works out a PatternWork for its preview, in steps. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "client/tools/pattern_work.hpp"

namespace runstone {

class PatternPreview {
 public:
  /// A preview has so many voxels that are decided one by one, at most: it is worked out as a whole,
  /// unlike the edits.
  static constexpr std::uint64_t kDecidedMax = std::uint64_t{1} << 25;

  explicit PatternPreview(std::uint64_t decided_max = kDecidedMax) : decided_max_(decided_max) {}

  /// Begins with another work; null ends the one under way.
  void set(PatternWorkPtr work);
  /// Returns true while there is more to do.
  bool is_under_way() const { return replacing_.has_value(); }
  /// Returns true if the preview was given up, because it takes too much time or memory.
  bool is_too_large() const { return is_too_large_; }
  /// Goes on for one turn, or to the end if `is_whole`. Returns the pastes, once, when all is done.
  std::optional<std::vector<BuildPaste>> step(MirroredBuilds& mirrored, bool is_whole);

 private:
  /// Begins with the box of the number box_.
  void begin();
  /// Takes what was made in the present box, with its copies.
  void take(MirroredBuilds& mirrored);

  std::uint64_t decided_max_;
  PatternWorkPtr work_;                 // null unless it is under way
  std::size_t box_ = 0;                 // number of the box of work_ that replacing_ works on
  std::optional<Replacing> replacing_;  // nullopt: not under way
  std::uint64_t decided_ = 0;           // in the boxes before
  std::vector<BuildPaste> made_;        // of the boxes before
  bool is_too_large_ = false;
};

}  // namespace runstone
