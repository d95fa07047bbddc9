#include "server/rollback/slice_edits.hpp"

#include <algorithm>
#include <numeric>
#include <variant>

namespace runstone {
namespace {

/// Returns the box of two boxes that share a whole side, or nullopt.
std::optional<VoxelBox> joined(const VoxelBox& a, const VoxelBox& b) {
  const VoxelBox both{
      {std::min(a.min.x, b.min.x), std::min(a.min.y, b.min.y), std::min(a.min.z, b.min.z)},
      {std::max(a.max.x, b.max.x), std::max(a.max.y, b.max.y), std::max(a.max.z, b.max.z)}};
  const bool x = a.min.x == b.min.x && a.max.x == b.max.x;
  const bool y = a.min.y == b.min.y && a.max.y == b.max.y;
  const bool z = a.min.z == b.min.z && a.max.z == b.max.z;
  const bool fits = (y && z && (a.max.x == b.min.x || b.max.x == a.min.x)) ||
                    (x && z && (a.max.y == b.min.y || b.max.y == a.min.y)) ||
                    (x && y && (a.max.z == b.min.z || b.max.z == a.min.z));
  return fits ? std::optional(both) : std::nullopt;
}

}  // namespace

void SliceEdits::add(const EditDescriptor& edit, Sequence subject) {
  const auto both = edits_.empty() || subjects_.back() != subject ? std::nullopt : with_last(edit);
  if (both) {
    work_ -= edit_work(edits_.back(), chunk_edge_);
    edits_.back() = *both;
    ++parts_.back();
  } else {
    edits_.push_back(edit);
    subjects_.push_back(subject);
    parts_.push_back(1);
  }
  work_ += edit_work(edits_.back(), chunk_edge_);
}

std::size_t SliceEdits::added_in(std::size_t count) const {
  return std::accumulate(parts_.begin(), parts_.begin() + static_cast<std::ptrdiff_t>(count),
                         std::size_t{0});
}

std::optional<EditDescriptor> SliceEdits::with_last(const EditDescriptor& edit) const {
  const EditDescriptor& last = edits_.back();
  const auto* a = std::get_if<FillBox>(&last.shape);
  const auto* b = std::get_if<FillBox>(&edit.shape);
  if (a == nullptr || b == nullptr || last.mask != edit.mask || last.material != edit.material)
    return std::nullopt;
  const auto box = joined(a->box, b->box);
  if (!box) return std::nullopt;
  EditDescriptor both = edit;
  both.shape = FillBox{*box};
  // The limits of edits bound the volume, also that of the author's role.
  if (world_.order().authority().check(both) || world_.rights().edit_refusal(author_, both))
    return std::nullopt;
  return both;
}

}  // namespace runstone
