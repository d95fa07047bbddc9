#include "client/tools/box_set.hpp"

#include <algorithm>
#include <utility>

#include "client/tools/aim.hpp"

namespace runstone {
namespace {

/// Returns the coordinates of a corner by axis.
constexpr std::int32_t VoxelPos::* kAlong[] = {&VoxelPos::x, &VoxelPos::y, &VoxelPos::z};

/// The boxes that are joined, at most. A set with more of them counts as one of too many boxes.
constexpr std::size_t kPartsMax = 4 * BoxSet::kBoxesMax;

/// Appends the part of a box outside of another one: up to two boxes along each axis.
void append_outside(VoxelBox box, const VoxelBox& other, std::vector<VoxelBox>& out) {
  const VoxelBox both = intersect(box, other);
  if (both.empty()) return out.push_back(box);
  for (const auto along : kAlong) {
    VoxelBox below = box, above = box;
    below.max.*along = box.min.*along = both.min.*along;
    above.min.*along = box.max.*along = both.max.*along;
    if (!below.empty()) out.push_back(below);
    if (!above.empty()) out.push_back(above);
  }
}

/// Returns the box of two boxes that touch with a whole side, or nullopt.
std::optional<VoxelBox> joined(const VoxelBox& a, const VoxelBox& b) {
  int differing = 0;
  bool is_touching = true;
  for (const auto along : kAlong) {
    if (a.min.*along == b.min.*along && a.max.*along == b.max.*along) continue;
    ++differing;
    is_touching = a.max.*along == b.min.*along || b.max.*along == a.min.*along;
  }
  if (differing != 1 || !is_touching) return std::nullopt;
  return bounding_box(a, b);
}

}  // namespace

BoxSet::BoxSet(const VoxelBox& box) {
  if (!box.empty()) boxes_.push_back(box);
}

VoxelBox BoxSet::around() const {
  VoxelBox out;
  for (const VoxelBox& box : boxes_) out = bounding_box(out, box);
  return out;
}

bool BoxSet::contains(VoxelPos voxel) const {
  return std::any_of(boxes_.begin(), boxes_.end(),
                     [&](const VoxelBox& box) { return box.contains(voxel); });
}

bool BoxSet::simplify() {
  // Each round but the last one removes a box.
  for (bool is_changed = boxes_.size() <= kPartsMax; is_changed;) {
    is_changed = false;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      for (std::size_t j = i + 1; j < boxes_.size(); ++j) {
        const auto both = joined(boxes_[i], boxes_[j]);
        if (!both) continue;
        boxes_[i] = *both;
        boxes_.erase(boxes_.begin() + static_cast<std::ptrdiff_t>(j));
        is_changed = true;
        j = i;
      }
    }
  }
  return boxes_.size() <= kBoxesMax;
}

std::optional<BoxSet> BoxSet::united(const BoxSet& a, const BoxSet& b) {
  auto out = without(b, a);
  if (!out) return std::nullopt;
  out->boxes_.insert(out->boxes_.begin(), a.boxes_.begin(), a.boxes_.end());
  return out->simplify() ? out : std::nullopt;
}

std::optional<BoxSet> BoxSet::without(const BoxSet& a, const BoxSet& b) {
  BoxSet out = a;
  std::vector<VoxelBox> left;
  for (const VoxelBox& other : b.boxes_) {
    left.clear();
    for (const VoxelBox& box : out.boxes_) append_outside(box, other, left);
    out.boxes_.swap(left);
    if (!out.simplify()) return std::nullopt;
  }
  return out;
}

std::optional<BoxSet> BoxSet::common(const BoxSet& a, const BoxSet& b) {
  BoxSet out;
  for (const VoxelBox& box : a.boxes_) {
    for (const VoxelBox& other : b.boxes_) {
      const VoxelBox both = intersect(box, other);
      if (!both.empty()) out.boxes_.push_back(both);
    }
  }
  return out.simplify() ? std::optional(std::move(out)) : std::nullopt;
}

BoxSet BoxSet::moved(Direction direction, std::int32_t steps) const {
  BoxSet out = *this;
  for (VoxelBox& box : out.boxes_) box = runstone::moved(box, direction, steps);
  return out;
}

std::optional<BoxSet> BoxSet::grown(Direction direction, std::int32_t steps) const {
  BoxSet out = *this;
  std::vector<VoxelBox> left, cut;
  for (const VoxelBox& box : boxes_) {
    VoxelBox longer = box;
    VoxelPos& corner = is_positive(direction) ? longer.max : longer.min;
    corner = runstone::moved(corner, direction, steps);
    left.clear();
    append_outside(longer, box, left);
    for (std::size_t i = 0; i < out.boxes_.size() && !left.empty(); ++i) {
      cut.clear();
      for (const VoxelBox& part : left) append_outside(part, out.boxes_[i], cut);
      left.swap(cut);
    }
    out.boxes_.insert(out.boxes_.end(), left.begin(), left.end());
    if (out.boxes_.size() > kPartsMax) return std::nullopt;
  }
  return out.simplify() ? std::optional(std::move(out)) : std::nullopt;
}

std::optional<BoxSet> BoxSet::shrunk(Direction direction, std::int32_t steps) const {
  // The set of `done` steps, moved by at most as many, gives that of up to twice as many steps.
  std::optional<BoxSet> out = *this;
  for (std::int32_t done = 0; done < steps && out;) {
    const std::int32_t more = std::min(std::max(done, 1), steps - done);
    out = common(*out, out->moved(opposite(direction), more));
    done += more;
  }
  return out;
}

}  // namespace runstone
