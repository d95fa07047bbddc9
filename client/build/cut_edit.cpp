#include "client/build/cut_edit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "client/build/drawn_edits.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"

namespace runstone {
namespace {

std::uint64_t side(std::int32_t low, std::int32_t high) {
  return high > low ? static_cast<std::uint64_t>(std::int64_t{high} - low) : 0;
}

std::uint64_t box_volume(const VoxelBox& box) {
  return side(box.min.x, box.max.x) * side(box.min.y, box.max.y) * side(box.min.z, box.max.z);
}

/// Returns the largest number whose cube is at most `n`.
std::uint64_t cube_root(std::uint64_t n) {
  auto root = static_cast<std::uint64_t>(std::cbrt(static_cast<double>(n)));
  while (root * root * root > n) --root;
  while ((root + 1) * (root + 1) * (root + 1) <= n) ++root;
  return root;
}

/// The sides of a piece, in voxels. Pieces lie on a grid of these sides.
using PieceSides = std::array<std::int32_t, 3>;

/// Returns sides of whole chunks with as many voxels as the limits allow. If not even a chunk is
/// allowed, the sides are a power of two, so that no piece lies in two chunks.
PieceSides piece_sides(const EditLimits& limits, std::int32_t side_max) {
  const auto edge = static_cast<std::uint64_t>(limits.chunk_edge);
  const std::uint64_t chunks =
      std::min(limits.volume_max / (edge * edge * edge), limits.touched_chunks_max);
  if (chunks == 0) {
    std::int32_t part = limits.chunk_edge;
    while (part > 1 && static_cast<std::uint64_t>(part) * static_cast<std::uint64_t>(part) *
                               static_cast<std::uint64_t>(part) >
                           limits.volume_max)
      part /= 2;
    return {part, part, part};
  }
  const auto most = static_cast<std::uint64_t>(side_max / limits.chunk_edge);
  const std::uint64_t z = std::clamp<std::uint64_t>(cube_root(chunks), 1, most);
  const auto y = std::clamp<std::uint64_t>(
      static_cast<std::uint64_t>(std::sqrt(static_cast<double>(chunks / z))), 1, most);
  const std::uint64_t x = std::clamp<std::uint64_t>(chunks / (z * y), 1, most);
  return {static_cast<std::int32_t>(x * edge), static_cast<std::int32_t>(y * edge),
          static_cast<std::int32_t>(z * edge)};
}

std::int32_t cell_of(std::int32_t at, std::int32_t of) {
  return at >= 0 ? at / of : -((-at + of - 1) / of);
}

/// The parts of a box on a grid, from the bottom to the top.
class GridParts {
 public:
  GridParts(const VoxelBox& box, const PieceSides& sides) : box_(box), sides_(sides) {
    if (box.empty()) return;
    first_ = {cell_of(box.min.x, sides[0]), cell_of(box.min.y, sides[1]),
              cell_of(box.min.z, sides[2])};
    last_ = {cell_of(box.max.x - 1, sides[0]), cell_of(box.max.y - 1, sides[1]),
             cell_of(box.max.z - 1, sides[2])};
    at_ = first_;
    has_more_ = true;
  }
  std::optional<VoxelBox> next() {
    if (!has_more_) return std::nullopt;
    const auto low = [this](std::size_t axis) { return at_[axis] * sides_[axis]; };
    const VoxelPos min{low(0), low(1), low(2)};
    const VoxelBox part =
        intersect(box_, VoxelBox{min, {min.x + sides_[0], min.y + sides_[1], min.z + sides_[2]}});
    for (const std::size_t axis : {std::size_t{0}, std::size_t{2}, std::size_t{1}}) {
      if (++at_[axis] <= last_[axis]) return part;
      at_[axis] = first_[axis];
    }
    has_more_ = false;
    return part;
  }

 private:
  VoxelBox box_;
  PieceSides sides_;
  std::array<std::int32_t, 3> first_{}, last_{}, at_{};
  bool has_more_ = false;
};

VoxelBox within_heights(VoxelBox box, const HeightLimits& heights) {
  box.min.y = std::max(box.min.y, heights.y_min);
  box.max.y = std::max(box.min.y, std::min(box.max.y, heights.y_max));
  return box;
}

class BoxPieces final : public EditSource {
 public:
  BoxPieces(const VoxelBox& box, const Mask& mask, Material material, const EditLimits& limits)
      : mask_(mask),
        material_(material),
        voxels_(box_volume(box)),
        parts_(box, piece_sides(limits, kEditBoxSideMax)) {}
  SourceStep next() override {
    const auto part = parts_.next();
    return part ? SourceStep::of({FillBox{*part}, mask_, material_}) : SourceStep::done();
  }
  std::uint64_t voxels() const override { return voxels_; }

 private:
  const Mask mask_;
  const Material material_;
  const std::uint64_t voxels_;
  GridParts parts_;
};

class OnePiece final : public EditSource {
 public:
  explicit OnePiece(const EditDescriptor& edit) : edit_(edit) {}
  SourceStep next() override {
    return std::exchange(is_done_, true) ? SourceStep::done() : SourceStep::of(edit_);
  }
  std::uint64_t voxels() const override { return counted_voxels(edit_); }

 private:
  const EditDescriptor edit_;
  bool is_done_ = false;
};

/// The parts of any shape, drawn one by one into a clipboard each. A part whose clipboard would be too
/// long is halved.
class ShapePieces final : public EditSource {
 public:
  ShapePieces(const EditDescriptor& edit, const EditLimits& limits)
      : edit_(edit),
        untouched_(*unused_material({&edit, 1})),  // one edit does not write all materials
        parts_(within_heights(bounding_box(edit), limits.heights),
               piece_sides(limits, std::int32_t{kSideMax})) {}
  SourceStep next() override {
    for (;;) {
      if (waiting_.empty()) {
        const auto part = parts_.next();
        if (!part) return SourceStep::done();
        waiting_.push_back(*part);
      }
      const VoxelBox box = waiting_.back();
      waiting_.pop_back();
      if (!touches(edit_, box)) continue;
      if (auto piece = piece_of(box)) return SourceStep::of(*std::move(piece));
    }
  }
  std::uint64_t voxels() const override { return counted_voxels(edit_); }

 private:
  /// Returns the part of the edit in the box, or nullopt after it has halved the box.
  std::optional<EditDescriptor> piece_of(const VoxelBox& box) {
    const DrawnEdits drawn = draw_edits({&edit_, 1}, box, untouched_, scratch_);
    if (drawn.is_uniform() && !std::holds_alternative<Paste>(edit_.shape))
      return EditDescriptor{FillBox{box}, edit_.mask, edit_.material};
    if (auto clipboard = drawn.clipboard())
      return EditDescriptor{Paste{box.min, *std::move(clipboard), {}}, edit_.mask, kEmpty};
    const Extent& extent = drawn.cells.extent;
    VoxelBox low = box, high = box;
    if (extent.x >= extent.y && extent.x >= extent.z) {
      low.max.x = high.min.x = box.min.x + extent.x / 2;
    } else if (extent.y >= extent.z) {
      low.max.y = high.min.y = box.min.y + extent.y / 2;
    } else {
      low.max.z = high.min.z = box.min.z + extent.z / 2;
    }
    waiting_.push_back(high);
    waiting_.push_back(low);
    return std::nullopt;
  }

  const EditDescriptor edit_;
  const Material untouched_;
  GridParts parts_;
  std::vector<VoxelBox> waiting_;  // the next one is last
  ApplyScratch scratch_;
};

}  // namespace

bool needs_cut(const EditDescriptor& edit, const EditLimits& limits) {
  if (const auto* fill = std::get_if<FillBox>(&edit.shape)) {
    const VoxelBox& box = fill->box;
    const std::uint64_t longest = std::max(
        {side(box.min.x, box.max.x), side(box.min.y, box.max.y), side(box.min.z, box.max.z)});
    if (longest > kEditBoxSideMax) return true;
  }
  return has_voxels(edit) && validate(edit) &&
         (counted_voxels(edit) > limits.volume_max ||
          touched_chunks_bound(edit, limits.chunk_edge) > limits.touched_chunks_max);
}

std::unique_ptr<EditSource> cut_box(const VoxelBox& box, const Mask& mask, Material material,
                                    const EditLimits& limits) {
  return std::make_unique<BoxPieces>(within_heights(box, limits.heights), mask, material, limits);
}

std::unique_ptr<EditSource> cut_edit(const EditDescriptor& edit, const EditLimits& limits) {
  if (!needs_cut(edit, limits)) return std::make_unique<OnePiece>(edit);
  if (const auto* fill = std::get_if<FillBox>(&edit.shape))
    return cut_box(fill->box, edit.mask, edit.material, limits);
  return std::make_unique<ShapePieces>(edit, limits);
}

}  // namespace runstone
