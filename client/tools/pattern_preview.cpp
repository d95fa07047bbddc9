#include "client/tools/pattern_preview.hpp"

#include <utility>

namespace runstone {

void PatternPreview::set(PatternWorkPtr work) {
  is_too_large_ = false;
  replacing_.reset();
  work_ = std::move(work);
  if (!work_) return;
  auto begun = replacing_in(work_, work_->box);
  is_too_large_ = !begun;
  if (begun) replacing_ = *std::move(begun);
}

std::optional<std::vector<BuildPaste>> PatternPreview::step(MirroredBuilds& mirrored,
                                                            bool is_whole) {
  if (!replacing_) return std::nullopt;
  bool is_done = false;
  do {
    std::uint64_t work = kPatternTurnWork;
    const auto done = replacing_->step(work);
    is_too_large_ = !done || replacing_->decided() > decided_max_;
    is_done = done && *done;
  } while (is_whole && !is_done && !is_too_large_);
  if (!is_done && !is_too_large_) return std::nullopt;
  std::vector<BuildPaste> out;
  if (!is_too_large_) {
    const auto placed = replacing_->finish();
    is_too_large_ = !placed;
    if (placed && placed->build) {
      out.push_back({placed->build, placed->at, {}, EmptyCells::pasted, true});
      for (const MirrorAxes axes : copies_of(work_->symmetry.kind)) {
        auto copy =
            runstone::mirrored(out.front(), axes, work_->symmetry, mirrored, work_->materials);
        if (copy) out.push_back(*std::move(copy));
        is_too_large_ = is_too_large_ || !copy;
      }
    }
  }
  replacing_.reset();
  work_.reset();
  if (is_too_large_) out.clear();
  return out;
}

}  // namespace runstone
