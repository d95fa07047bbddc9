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
  /// A preview has so many voxels that are decided one by one, at most, each counted with its mirrored
  /// copies: it is worked out as a whole, unlike the edits.
  static constexpr std::uint64_t kDecidedMax = std::uint64_t{1} << 25;

  explicit PatternPreview(std::uint64_t decided_max = kDecidedMax) : decided_max_(decided_max) {}

  /// Begins with another work; null ends the one under way. A work of more boxes, with their mirrored
  /// copies, than BuildPreview::kBuildsMax is given up at once.
  void set(PatternWorkPtr work);
  /// Returns true while there is more to do.
  bool is_under_way() const { return work_ != nullptr; }
  /// Returns true if the preview was given up, because it takes too much time or memory.
  bool is_too_large() const { return is_too_large_; }
  /// Goes on for one turn, or to the end if `is_whole`. A turn does the work of a step, or mirrors the
  /// build of one box. Returns the pastes, once, when all is done.
  std::optional<std::vector<BuildPaste>> step(MirroredBuilds& mirrored, bool is_whole);

 private:
  /// Begins with the box of the number box_.
  void begin();
  /// Does the work of one turn. Returns true if all boxes are done.
  bool go_on(MirroredBuilds& mirrored);
  /// Goes on in the present box. Returns true if it is done.
  bool replace();
  /// Makes the next copy of copied_.
  void add_copy(MirroredBuilds& mirrored);

  std::uint64_t decided_max_;
  PatternWorkPtr work_;  // null unless it is under way
  std::size_t box_ = 0;  // number of the box of work_ that replacing_ works on
  std::optional<Replacing> replacing_;
  std::uint64_t decided_ = 0;         // in the boxes before
  std::vector<MirrorAxes> copies_;    // of each box
  std::optional<BuildPaste> copied_;  // of the present box, while copies of it are missing
  std::size_t copy_ = 0;              // number of the next copy of copied_
  std::vector<BuildPaste> made_;      // so far
  bool is_too_large_ = false;
};

}  // namespace runstone
