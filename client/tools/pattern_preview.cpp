#include "client/tools/pattern_preview.hpp"

#include <utility>

#include "client/tools/build_preview.hpp"

namespace runstone {

void PatternPreview::set(PatternWorkPtr work) {
  work_ = std::move(work);
  is_too_large_ = false;
  replacing_.reset();
  copied_.reset();
  made_.clear();
  box_ = 0;
  decided_ = 0;
  if (!work_) return;
  copies_ = copies_of(work_->symmetry.kind);
  is_too_large_ = work_->boxes.size() * (1 + copies_.size()) > BuildPreview::kBuildsMax;
  if (!is_too_large_) begin();
  if (is_too_large_) work_.reset();
}

void PatternPreview::begin() {
  replacing_.reset();
  auto begun = replacing_in(work_, work_->boxes[box_]);
  is_too_large_ = !begun;
  if (begun) replacing_ = *std::move(begun);
}

bool PatternPreview::replace() {
  std::uint64_t work = kPatternTurnWork;
  const auto done = replacing_->step(work);
  const std::uint64_t decided = decided_ + replacing_->decided();
  is_too_large_ = !done || decided * (1 + copies_.size()) > decided_max_;
  if (is_too_large_ || !*done) return false;
  decided_ = decided;
  const auto placed = replacing_->finish();
  is_too_large_ = !placed;
  if (!placed) return false;
  if (!placed->build) return true;
  made_.push_back({placed->build, placed->at, {}, EmptyCells::pasted, true});
  copy_ = 0;
  if (!copies_.empty()) copied_ = made_.back();
  return true;
}

void PatternPreview::add_copy(MirroredBuilds& mirrored) {
  auto copy =
      runstone::mirrored(*copied_, copies_[copy_], work_->symmetry, mirrored, work_->materials);
  is_too_large_ = !copy;
  if (copy) made_.push_back(*std::move(copy));
  if (++copy_ == copies_.size()) copied_.reset();
}

bool PatternPreview::go_on(MirroredBuilds& mirrored) {
  if (copied_) {
    add_copy(mirrored);
  } else if (!replace()) {
    return false;
  }
  if (is_too_large_ || copied_) return false;
  if (++box_ == work_->boxes.size()) return true;
  begin();
  return false;
}

std::optional<std::vector<BuildPaste>> PatternPreview::step(MirroredBuilds& mirrored,
                                                            bool is_whole) {
  if (!work_) return std::nullopt;
  bool is_done = go_on(mirrored);
  while (is_whole && !is_done && !is_too_large_) is_done = go_on(mirrored);
  if (!is_done && !is_too_large_) return std::nullopt;
  replacing_.reset();
  copied_.reset();
  work_.reset();
  if (is_too_large_) made_.clear();
  return std::exchange(made_, {});
}

}  // namespace runstone
