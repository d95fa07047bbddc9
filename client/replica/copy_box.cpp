#include "client/replica/copy_box.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "common/edits/clipboard/clipboard_builder.hpp"
#include "common/runs/cut.hpp"
#include "common/runs/reorder.hpp"

namespace runstone {
namespace {

// The builder gets the voxels in this order, whatever the order of the chunks.
constexpr AxisOrder kOrder = AxisOrder::xyz;

/// Reads the part of a chunk that lies in the box, from its first voxel to its last.
class PartReader {
 public:
  explicit PartReader(RunChunk part) : part_(std::move(part)) {}

  /// Appends the next line.
  void line(ClipboardBuilder& out, CopyEmpty empty) {
    for (std::uint32_t left = part_.extent.x; left != 0;) {
      const Run run = part_.runs[run_];
      const std::uint32_t count = std::min(left, run.end - at_);
      const bool leaves = run.material == kEmpty && empty == CopyEmpty::as_untouched;
      out.append(count, leaves ? std::nullopt : std::optional<Material>(run.material));
      at_ += count;
      left -= count;
      if (at_ == run.end) ++run_;
    }
  }

 private:
  RunChunk part_;
  std::size_t run_ = 0;
  std::uint32_t at_ = 0;
};

Extent extent_of(const VoxelBox& box) {
  return {static_cast<std::uint8_t>(box.max.x - box.min.x),
          static_cast<std::uint8_t>(box.max.y - box.min.y),
          static_cast<std::uint8_t>(box.max.z - box.min.z)};
}

bool inside_world(const VoxelBox& box) {
  for (const std::int32_t c : {box.min.x, box.min.y, box.min.z}) {
    if (c < -kWorldLimit || c >= kWorldLimit) return false;
  }
  for (const std::int32_t c : {box.max.x, box.max.y, box.max.z}) {
    if (c > kWorldLimit) return false;
  }
  return true;
}

}  // namespace

Result<std::shared_ptr<const Clipboard>> copy_box(const Replica& replica, const VoxelBox& box,
                                                  CopyEmpty empty) {
  if (box.empty()) return fail(ErrorCode::bad_value, "box to copy is empty");
  if (!replica.opened()) return fail(ErrorCode::bad_value, "no world is open");
  if (!inside_world(box))
    return fail(ErrorCode::bad_value, "box to copy reaches outside the world");
  const auto side_max = static_cast<std::int32_t>(kSideMax);
  if (box.max.x - box.min.x > side_max || box.max.y - box.min.y > side_max ||
      box.max.z - box.min.z > side_max) {
    return fail(ErrorCode::limit_exceeded, "box to copy is longer than 128 voxels");
  }
  const std::int32_t edge = replica.chunk_edge();
  const ChunkCoord first = chunk_of(box.min, edge);
  const ChunkCoord last = chunk_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, edge);
  std::vector<PartReader> parts;  // by z, then y, then x
  for (std::int32_t z = first.z; z <= last.z; ++z) {
    for (std::int32_t y = first.y; y <= last.y; ++y) {
      for (std::int32_t x = first.x; x <= last.x; ++x) {
        const ChunkCoord at{x, y, z};
        const ShownPtr chunk = replica.shown({0, at});
        if (!chunk) return fail(ErrorCode::not_found, "a chunk of the box to copy is not loaded");
        const VoxelBox part = intersect(box, box_of(at, edge));
        parts.emplace_back(reorder(cut(*chunk, local_of(part.min, edge), extent_of(part)), kOrder));
      }
    }
  }
  const auto row = static_cast<std::size_t>(last.x - first.x + 1);
  const auto rows = static_cast<std::size_t>(last.y - first.y + 1);
  ClipboardBuilder out(extent_of(box), kOrder);
  for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
    for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
      const ChunkCoord at = chunk_of({box.min.x, y, z}, edge);
      const std::size_t begin = (static_cast<std::size_t>(at.z - first.z) * rows +
                                 static_cast<std::size_t>(at.y - first.y)) *
                                row;
      for (std::size_t i = begin; i < begin + row; ++i) parts[i].line(out, empty);
    }
  }
  return out.finish();
}

}  // namespace runstone
