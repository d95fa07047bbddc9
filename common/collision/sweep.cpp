#include "common/collision/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
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

std::optional<SweepHit> sweep_cubes(const VoxelSpace& space, const MaterialSet& solid,
                                    const BodyBox& box, const WorldPos& move) {
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

/// A box of a shape in the world.
struct SolidBox {
  Numbers min{}, max{};
};

/// Calls visit(voxel, box) for each box of the shapes that are obstacles in these voxels.
template <class Visit>
void visit_boxes(const VoxelSpace& space, const Obstacles& solid, const VoxelBox& voxels,
                 const Visit& visit) {
  visit_voxels(space, solid.shapes(), voxels, [&](VoxelPos at, Material material) {
    const Numbers corner = {double(at.x), double(at.y), double(at.z)};
    for (const ShapeBox& box : solid.table()[material].shape.boxes) {
      SolidBox in_world;
      for (std::size_t a = 0; a < 3; ++a) {
        in_world.min[a] = corner[a] + box.min[a] / double{kShapeUnits};
        in_world.max[a] = corner[a] + box.max[a] / double{kShapeUnits};
      }
      visit(at, in_world);
    }
  });
}

/// Returns the fraction of the move at which the body meets the box, and the axis of the face, or
/// nullopt if it passes, or overlaps the box by more than kTouchDepth from the start. The intervals
/// of the body are kTouchDepth shorter at both ends.
std::optional<std::pair<double, std::size_t>> meets(const Numbers& min, const Numbers& max,
                                                    const Numbers& by, const SolidBox& box) {
  double enters = -1, leaves = 1;
  std::size_t axis = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double low = min[a] + kTouchDepth, high = max[a] - kTouchDepth;
    if (by[a] == 0) {
      if (high <= box.min[a] || low >= box.max[a]) return std::nullopt;
      continue;
    }
    const double in = (by[a] > 0 ? box.min[a] - high : box.max[a] - low) / by[a];
    const double out = (by[a] > 0 ? box.max[a] - low : box.min[a] - high) / by[a];
    if (in > enters) enters = in, axis = a;
    leaves = std::min(leaves, out);
  }
  if (enters < 0 || enters >= leaves || enters > 1) return std::nullopt;
  return std::pair{std::max(0.0, enters - kTouchDepth / std::abs(by[axis])), axis};
}

/// Returns the first box of a shape that the body meets before `end`, a fraction of the move. The
/// move is looked at in parts of at most this length, voxels, so that few voxels that the body
/// does not pass are read.
constexpr double kPartMax = 4;
std::optional<SweepHit> sweep_shapes(const VoxelSpace& space, const Obstacles& solid,
                                     const BodyBox& body, const WorldPos& move, double end) {
  const Numbers min = numbers_of(body.min), max = numbers_of(body.max), by = numbers_of(move);
  const double longest = std::max({std::abs(by[0]), std::abs(by[1]), std::abs(by[2])});
  const int parts = std::max(1, static_cast<int>(std::ceil(longest * end / kPartMax)));
  std::optional<SweepHit> out;
  for (int part = 0; part < parts && !out; ++part) {
    // A box that is met later is found again in its part.
    const double since = end * part / parts, until = end * (part + 1) / parts;
    std::array<Cells, 3> cells;
    for (std::size_t a = 0; a < 3; ++a) {
      const double from = by[a] * since, to = by[a] * until;
      // With the voxels that the body only touches.
      const double low = min[a] + std::min(from, to) - kTouchDepth;
      const double high = max[a] + std::max(from, to) + kTouchDepth;
      const auto limit = static_cast<double>(kWorldLimit);
      cells[a] = {static_cast<std::int32_t>(std::floor(std::max(low, -limit))),
                  static_cast<std::int32_t>(std::ceil(std::min(high, limit))) - 1};
    }
    visit_boxes(space, solid, box_of_cells(cells), [&](VoxelPos at, const SolidBox& box) {
      const auto hit = meets(min, max, by, box);
      if (!hit || hit->first > until || (out && out->fraction <= hit->first)) return;
      out = SweepHit{hit->first,
                     static_cast<Direction>(hit->second * 2 + (by[hit->second] < 0 ? 1U : 0U)), at};
    });
  }
  return out;
}

}  // namespace

Result<void> validate_move(const BodyBox& box, const WorldPos& move) {
  const Numbers min = numbers_of(box.min), max = numbers_of(box.max), by = numbers_of(move);
  for (std::size_t a = 0; a < 3; ++a) {
    // A comparison with a number that is none is false. A thinner body overlaps no voxel, and a move
    // could round both of its ends to one number.
    if (!(max[a] - min[a] > 2 * kTouchDepth))
      return fail(ErrorCode::bad_value, "body without a size on an axis");
    if (!(std::abs(by[a]) <= kSweepMax))
      return fail(ErrorCode::bad_value, "move of more than 256 voxels on an axis");
    if (!(min[a] + std::min(by[a], 0.0) >= -kWorldLimit &&
          max[a] + std::max(by[a], 0.0) <= kWorldLimit))
      return fail(ErrorCode::bad_value, "move that leaves the world");
  }
  return {};
}

std::optional<SweepHit> sweep(const VoxelSpace& space, const Obstacles& solid, const BodyBox& box,
                              const WorldPos& move) {
  const std::optional<SweepHit> cube = sweep_cubes(space, solid.cubes(), box, move);
  if (!solid.has_shapes()) return cube;
  const auto shape = sweep_shapes(space, solid, box, move, cube ? cube->fraction : 1);
  return shape ? shape : cube;
}

bool overlaps(const VoxelSpace& space, const MaterialSet& materials, const BodyBox& box) {
  return find_voxel(space, materials, voxels_of(box)).has_value();
}

bool overlaps(const VoxelSpace& space, const Obstacles& solid, const BodyBox& box) {
  if (overlaps(space, solid.cubes(), box)) return true;
  if (!solid.has_shapes()) return false;
  bool out = false;
  const Numbers min = numbers_of(box.min), max = numbers_of(box.max);
  visit_boxes(space, solid, voxels_of(box), [&](VoxelPos, const SolidBox& obstacle) {
    bool meets = true;
    for (std::size_t a = 0; a < 3; ++a) {
      meets =
          meets && obstacle.min[a] < max[a] - kTouchDepth && obstacle.max[a] > min[a] + kTouchDepth;
    }
    out = out || meets;
  });
  return out;
}

bool is_known(const VoxelSpace& space, const BodyBox& box) {
  static const MaterialSet kNothingButUnknown(std::vector<bool>(kMaterialCountMax), true);
  return !find_voxel(space, kNothingButUnknown, voxels_of(box)).has_value();
}

Slide slide(const VoxelSpace& space, const Obstacles& solid, const BodyBox& box,
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
