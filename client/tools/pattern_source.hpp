// PatternSource: the edits of a PatternWork, worked out part by part while they are sent. So a box of
// any size takes the memory of one part, and a turn the time of one step. First come the edits of all
// parts of the boxes, then those of each mirrored copy. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/build/edit_source.hpp"
#include "client/tools/pattern_work.hpp"
#include "common/builds/paste_source.hpp"
#include "protocol/rules/edit_check.hpp"

namespace runstone {

/// The sizes of the steps of a PatternSource.
struct PatternSteps {
  /// The sides of the parts. They are cut on a grid that begins at the origin of the world. A pattern
  /// with mirrored copies has sides of at most 64, because a part is mirrored in one turn.
  VoxelPos part_sides{256, 64, 256};
  std::uint64_t turn_work = kPatternTurnWork;
};

class PatternSource final : public EditSource {
 public:
  PatternSource(PatternWorkPtr work, const EditLimits& limits, const PatternSteps& steps = {});

  /// Returns the step `wait` if the work of a turn is done and no edit is ready. Returns `failed` at
  /// the end if no voxel changes. Cost of all calls up to the next `wait`: steps.turn_work, and that of
  /// PasteSource::next() for each.
  SourceStep next() override;
  /// Returns 0: the number of voxels that change is not known before the end.
  std::uint64_t voxels() const override { return 0; }

 private:
  /// Moves to the next part, to the first part of the next box or of the next copy, or behind the
  /// last copy.
  void advance();
  /// Begins the part of the present box with this lowest corner.
  void begin(VoxelPos min);
  /// Makes the edits of a build that was replaced in a part. Returns why there are none, if so.
  std::optional<std::string> take(PlacedBuild placed);

  const PatternWorkPtr work_;
  const PasteLimits limits_;
  const PatternSteps steps_;
  const std::vector<MirrorAxes> copies_;
  std::size_t pass_ = 0;     // 0: the boxes themselves; otherwise one more than the copy's number
  std::size_t box_ = 0;      // number of the box of part_
  VoxelBox part_;            // the part that is worked out now
  std::uint64_t work_left_;  // of this turn
  std::optional<Replacing> replacing_;  // in part_; nullopt: not begun
  std::optional<PasteSource> edits_;    // the edits of the part before part_
  MirroredBuilds mirrored_;
  bool has_edits_ = false;
  std::string failure_;  // not empty: the source has failed
};

}  // namespace runstone
