#include "client/tools/pattern_source.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "protocol/rules/paste_limits.hpp"

namespace runstone {
namespace {

/// Returns the next border of a grid behind `at`, at most `end`.
std::int32_t next_border(std::int32_t at, std::int32_t side, std::int32_t end) {
  const std::int64_t border = (std::int64_t{floor_div(at, side)} + 1) * side;
  return static_cast<std::int32_t>(std::min<std::int64_t>(border, end));
}

/// The longest side of a part that is mirrored.
constexpr std::int32_t kMirroredSideMax = 64;

PatternSteps steps_with(PatternSteps steps, SymmetryKind kind) {
  if (kind == SymmetryKind::none) return steps;
  VoxelPos& sides = steps.part_sides;
  sides = {std::min(sides.x, kMirroredSideMax), std::min(sides.y, kMirroredSideMax),
           std::min(sides.z, kMirroredSideMax)};
  return steps;
}

}  // namespace

PatternSource::PatternSource(PatternWorkPtr work, const EditLimits& limits,
                             const PatternSteps& steps)
    : work_(std::move(work)),
      limits_(paste_limits(limits)),
      steps_(steps_with(steps, work_->symmetry.kind)),
      copies_(copies_of(work_->symmetry.kind)),
      work_left_(steps.turn_work) {
  begin(work_->boxes.front().min);
}

void PatternSource::begin(VoxelPos min) {
  const VoxelBox& box = work_->boxes[box_];
  const VoxelPos& sides = steps_.part_sides;
  part_ = {min,
           {next_border(min.x, sides.x, box.max.x), next_border(min.y, sides.y, box.max.y),
            next_border(min.z, sides.z, box.max.z)}};
}

void PatternSource::advance() {
  const VoxelBox& box = work_->boxes[box_];
  // The next part lies along x first, then along z, then along y.
  if (part_.max.x < box.max.x) return begin({part_.max.x, part_.min.y, part_.min.z});
  if (part_.max.z < box.max.z) return begin({box.min.x, part_.min.y, part_.max.z});
  if (part_.max.y < box.max.y) return begin({box.min.x, part_.max.y, box.min.z});
  if (++box_ == work_->boxes.size()) {
    box_ = 0;
    ++pass_;
  }
  begin(work_->boxes[box_].min);
}

std::optional<std::string> PatternSource::take(PlacedBuild placed) {
  if (!placed.build) return std::nullopt;
  BuildPaste paste{std::move(placed.build), placed.at, {}, EmptyCells::pasted, true};
  if (pass_ > 0) {
    auto copy = mirrored(paste, copies_[pass_ - 1], work_->symmetry, mirrored_, work_->materials);
    if (!copy) return copy.error();
    paste = *std::move(copy);
  }
  edits_.emplace(paste.build, paste.at, paste.mask, paste.empty, limits_);
  has_edits_ = true;
  return std::nullopt;
}

SourceStep PatternSource::next() {
  while (failure_.empty()) {
    if (edits_) {
      if (auto edit = edits_->next()) return SourceStep::of(*std::move(edit));
      edits_.reset();
    }
    if (pass_ > copies_.size()) {
      if (has_edits_) return SourceStep::done();
      failure_ = "the pattern changes no voxel there";
      break;
    }
    if (!replacing_) {
      auto begun = replacing_in(work_, part_);
      if (!begun) {
        failure_ = pattern_failure(begun.error());
        break;
      }
      replacing_ = *std::move(begun);
    }
    const auto is_done = replacing_->step(work_left_);
    if (is_done && !*is_done) {
      work_left_ = steps_.turn_work;
      return SourceStep::later("its next part is worked out");
    }
    auto placed = is_done ? replacing_->finish() : Result<PlacedBuild>(failure(is_done.error()));
    replacing_.reset();
    if (!placed) {
      failure_ = pattern_failure(placed.error());
      break;
    }
    if (auto why = take(*std::move(placed))) failure_ = *std::move(why);
    advance();
  }
  return SourceStep::failure(failure_);
}

}  // namespace runstone
