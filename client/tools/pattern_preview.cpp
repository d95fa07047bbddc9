#include "client/tools/pattern_preview.hpp"

#include <utility>

#include "client/tools/build_preview.hpp"

namespace runstone {

void PatternPreview::set(PatternWorkPtr work) {
  work_ = std::move(work);
  is_too_large_ = false;
  replacing_.reset();
  made_.clear();
  box_ = 0;
  decided_ = 0;
  if (work_) begin();
}

void PatternPreview::begin() {
  replacing_.reset();
  auto begun = replacing_in(work_, work_->boxes[box_]);
  is_too_large_ = !begun;
  if (begun) replacing_ = *std::move(begun);
}

void PatternPreview::take(MirroredBuilds& mirrored) {
  decided_ += replacing_->decided();
  const auto placed = replacing_->finish();
  is_too_large_ = !placed;
  if (!placed || !placed->build) return;
  const BuildPaste paste{placed->build, placed->at, {}, EmptyCells::pasted, true};
  made_.push_back(paste);
  for (const MirrorAxes axes : copies_of(work_->symmetry.kind)) {
    auto copy = runstone::mirrored(paste, axes, work_->symmetry, mirrored, work_->materials);
    if (copy) made_.push_back(*std::move(copy));
    is_too_large_ = is_too_large_ || !copy;
  }
  is_too_large_ = is_too_large_ || made_.size() > BuildPreview::kBuildsMax;
}

std::optional<std::vector<BuildPaste>> PatternPreview::step(MirroredBuilds& mirrored,
                                                            bool is_whole) {
  if (!replacing_) return std::nullopt;
  bool is_done = false;
  do {
    std::uint64_t work = kPatternTurnWork;
    const auto done = replacing_->step(work);
    is_too_large_ = !done || decided_ + replacing_->decided() > decided_max_;
    if (is_too_large_ || !*done) continue;
    take(mirrored);
    is_done = ++box_ == work_->boxes.size();
    if (!is_done && !is_too_large_) begin();
  } while (is_whole && !is_done && !is_too_large_);
  if (!is_done && !is_too_large_) return std::nullopt;
  replacing_.reset();
  work_.reset();
  if (is_too_large_) made_.clear();
  return std::exchange(made_, {});
}

}  // namespace runstone
