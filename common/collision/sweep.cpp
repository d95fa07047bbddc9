#include "common/collision/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

using Numbers = std::array<double, 3>;  // by axis

Numbers numbers_of(const WorldPos& p) { return {p.x, p.y, p.z}; }
WorldPos pos_of_numbers(const Numbers& n) { return {n[0], n[1], n[2]}; }

/// Voxels from `first` to `last`, both included; none if last < first.
struct Cells {
  std::int32_t first = 0, last = 0;
};

/// Returns the voxels that an interval overlaps by more than kTouchDepth at both ends.
Cells cells_of(double min, double max) {
  return {static_cast<std::int32_t>(std::floor(min + kTouchDepth)),
          static_cast<std::int32_t>(std::ceil(max - kTouchDepth)) - 1};
}

VoxelBox box_of_cells(const std::array<Cells, 3>& cells) {
  return {{cells[0].first, cells[1].first, cells[2].first},
          {cells[0].last + 1, cells[1].last + 1, cells[2].last + 1}};
}

VoxelBox voxels_of(const BodyBox& box) {
  return box_of_cells({cells_of(box.min.x, box.max.x), cells_of(box.min.y, box.max.y),
                       cells_of(box.min.z, box.max.z)});
}

/// One axis of the move: the voxels that the box overlaps, and when its leading face enters the
/// next layer.
struct AxisSweep {
  AxisSweep(double min, double max, double move) : min_(min), max_(max), move_(move) {
    cells_ = cells_of(min, max);
    step_ = move > 0 ? 1 : move < 0 ? -1 : 0;
    find_next();
  }

  /// The fraction of the move at which the leading face enters the next layer; infinite if it never
  /// does.
  double next() const { return next_; }
  /// Enters the next layer and returns it.
  std::int32_t enter() {
    (step_ > 0 ? cells_.last : cells_.first) += step_;
    find_next();
    return step_ > 0 ? cells_.last : cells_.first;
  }
  /// Returns the voxels that the box overlaps at this fraction of the move. The leading end counts
  /// the layers that were entered, so that no corner is passed between two layers that are entered
  /// at the same time.
  Cells cells_at(double fraction) const {
    if (step_ == 0) return cells_;
    const Cells now = cells_of(min_ + move_ * fraction, max_ + move_ * fraction);
    if (step_ > 0) return {std::min(now.first, cells_.last), cells_.last};
    return {cells_.first, std::max(now.last, cells_.first)};
  }
  Direction face(std::size_t axis) const {
    return static_cast<Direction>(axis * 2 + (step_ < 0 ? 1U : 0U));
  }

 private:
  void find_next() {
    if (step_ == 0) return;
    const double border = step_ > 0 ? cells_.last + 1 - max_ : cells_.first - min_;
    // A face that is behind a border by kTouchDepth or less, at the start or at the end, touches
    // it.
    if (std::abs(move_) - step_ * border <= kTouchDepth) {
      next_ = std::numeric_limits<double>::infinity();
    } else {
      next_ = std::max(border / move_, 0.0);
    }
  }

  double min_, max_, move_;
  Cells cells_;
  std::int32_t step_ = 0;
  double next_ = std::numeric_limits<double>::infinity();
};

}  // namespace

Result<void> validate_move(const BodyBox& box, const WorldPos& move) {
  const Numbers min = numbers_of(box.min), max = numbers_of(box.max), by = numbers_of(move);
  for (std::size_t a = 0; a < 3; ++a) {
    // A comparison with a number that is none is false.
    if (!(min[a] < max[a])) return fail(ErrorCode::bad_value, "body without a size on an axis");
    if (!(std::abs(by[a]) <= kSweepMax))
      return fail(ErrorCode::bad_value, "move of more than 256 voxels on an axis");
    if (!(min[a] + std::min(by[a], 0.0) >= -kWorldLimit &&
          max[a] + std::max(by[a], 0.0) <= kWorldLimit))
      return fail(ErrorCode::bad_value, "move that leaves the world");
  }
  return {};
}

std::optional<SweepHit> sweep(const VoxelSpace& space, const MaterialSet& solid, const BodyBox& box,
                              const WorldPos& move) {
  const Numbers min = numbers_of(box.min), max = numbers_of(box.max), by = numbers_of(move);
  for (std::size_t a = 0; a < 3; ++a)
    RUNSTONE_ASSERT(min[a] < max[a] && std::abs(by[a]) <= kSweepMax);
  std::array<AxisSweep, 3> axes = {AxisSweep{min[0], max[0], by[0]},
                                   AxisSweep{min[1], max[1], by[1]},
                                   AxisSweep{min[2], max[2], by[2]}};
  for (;;) {
    const auto soonest = std::min_element(
        axes.begin(), axes.end(),
        [](const AxisSweep& a, const AxisSweep& b) { return a.next() < b.next(); });
    const double fraction = soonest->next();
    if (!std::isfinite(fraction)) return std::nullopt;
    const auto axis = static_cast<std::size_t>(soonest - axes.begin());
    const std::int32_t layer = soonest->enter();
    std::array<Cells, 3> entered;
    for (std::size_t a = 0; a < 3; ++a) entered[a] = axes[a].cells_at(fraction);
    entered[axis] = {layer, layer};
    if (const auto voxel = find_voxel(space, solid, box_of_cells(entered)))
      return SweepHit{fraction, soonest->face(axis), *voxel};
  }
}

bool overlaps(const VoxelSpace& space, const MaterialSet& materials, const BodyBox& box) {
  return find_voxel(space, materials, voxels_of(box)).has_value();
}

bool is_known(const VoxelSpace& space, const BodyBox& box) {
  static const MaterialSet kNothingButUnknown(std::vector<bool>(kMaterialCountMax), true);
  return !find_voxel(space, kNothingButUnknown, voxels_of(box)).has_value();
}

Slide slide(const VoxelSpace& space, const MaterialSet& solid, const BodyBox& box,
            const WorldPos& move) {
  Slide out;
  Numbers min = numbers_of(box.min), max = numbers_of(box.max), rest = numbers_of(move);
  Numbers moved{};
  // Each hit ends the move along one axis.
  for (int pass = 0; pass < 3; ++pass) {
    const auto hit =
        sweep(space, solid, {pos_of_numbers(min), pos_of_numbers(max)}, pos_of_numbers(rest));
    const double fraction = hit ? hit->fraction : 1;
    for (std::size_t a = 0; a < 3; ++a) {
      const double part = rest[a] * fraction;
      min[a] += part;
      max[a] += part;
      moved[a] += part;
      rest[a] -= part;
    }
    if (!hit) break;
    out.is_stopped[static_cast<std::size_t>(opposite(hit->face))] = true;
    rest[static_cast<std::size_t>(axis_of(hit->face))] = 0;
  }
  out.moved = pos_of_numbers(moved);
  return out;
}

}  // namespace runstone
