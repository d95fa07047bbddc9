#include "common/rights/box_parts.hpp"

#include <utility>

namespace runstone {
namespace {

/// Appends the part of `from` around `hole`: two slabs along x, two along z between them, and two
/// along y between these. Requires that `hole` lies in `from` and is not empty.
void append_around(const VoxelBox& from, const VoxelBox& hole, std::vector<VoxelBox>& out) {
  const VoxelPos &a = from.min, &b = from.max, &c = hole.min, &d = hole.max;
  const VoxelBox around[6] = {
      {a, {c.x, b.y, b.z}},                // below along x
      {{d.x, a.y, a.z}, b},                // above along x
      {{c.x, a.y, a.z}, {d.x, b.y, c.z}},  // below along z
      {{c.x, a.y, d.z}, {d.x, b.y, b.z}},  // above along z
      {{c.x, a.y, c.z}, {d.x, c.y, d.z}},  // below along y
      {{c.x, d.y, c.z}, {d.x, b.y, d.z}},  // above along y
  };
  for (const VoxelBox& part : around) {
    if (!part.empty()) out.push_back(part);
  }
}

}  // namespace

bool cut_out(std::vector<VoxelBox>& parts, const VoxelBox& hole, std::size_t parts_max) {
  std::vector<VoxelBox> left;
  for (const VoxelBox& part : parts) {
    const VoxelBox common = intersect(part, hole);
    if (common.empty()) {
      left.push_back(part);
    } else {
      append_around(part, common, left);
    }
    if (left.size() > parts_max) return false;
  }
  parts = std::move(left);
  return true;
}

}  // namespace runstone
