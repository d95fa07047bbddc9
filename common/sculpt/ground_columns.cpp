#include "common/sculpt/ground_columns.hpp"

#include <algorithm>

#include "common/core/assert.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_cursor.hpp"

namespace runstone {
namespace {

/// A chunk of a stack, with lines along y, and the place up to which its runs were read.
struct StackedChunk {
  std::shared_ptr<const RunChunk> chunk;
  std::size_t run = 0;
};

/// Appends the voxels [low, high) of a line, whose first voxel lies at height `base`, to the runs
/// of a column that begin at `first`.
void append_line(StackedChunk& from, std::uint32_t line_start, std::int32_t base, std::int32_t low,
                 std::int32_t high, std::size_t first, std::vector<ColumnRun>& out) {
  const RunList& runs = from.chunk->runs;
  const auto voxel = line_start + static_cast<std::uint32_t>(low - base);
  while (runs.end(from.run) <= voxel) ++from.run;
  for (std::size_t i = from.run;; ++i) {
    const Run run = runs[i];
    const auto end = static_cast<std::int32_t>(
        std::min<std::int64_t>(high, base + std::int64_t{run.end} - line_start));
    if (out.size() > first && out.back().material == run.material) {
      out.back().end = end;
    } else {
      out.push_back({end, run.material});
    }
    if (end == high) return;
  }
}

}  // namespace

Result<GroundColumns> GroundColumns::read(const VoxelBox& box, std::int32_t chunk_edge,
                                          const ChunkLookup& chunks) {
  RUNSTONE_ASSERT(!box.empty() && chunk_edge > 0);
  GroundColumns out;
  out.box_ = box;
  const std::int64_t columns = std::int64_t{box.max.x - box.min.x} * (box.max.z - box.min.z);
  if (columns > kGroundColumnsMax)
    return fail(ErrorCode::limit_exceeded, "the area has more than 1,048,576 columns");
  out.spans_.resize(static_cast<std::size_t>(columns));
  const ChunkCoord low = chunk_of(box.min, chunk_edge);
  const ChunkCoord high = chunk_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, chunk_edge);
  for (std::int32_t z = low.z; z <= high.z; ++z) {
    for (std::int32_t x = low.x; x <= high.x; ++x) out.read_stack(x, z, chunk_edge, chunks);
  }
  return out;
}

void GroundColumns::read_stack(std::int32_t chunk_x, std::int32_t chunk_z, std::int32_t edge,
                               const ChunkLookup& chunks) {
  const std::int32_t low = floor_div(box_.min.y, edge), high = floor_div(box_.max.y - 1, edge);
  std::vector<StackedChunk> stack;
  for (std::int32_t y = low; y <= high; ++y) {
    auto chunk = chunks({chunk_x, y, chunk_z});
    if (chunk == nullptr) return;
    if (chunk->order != AxisOrder::yxz && !chunk->is_uniform())
      chunk = std::make_shared<RunChunk>(reorder(*chunk, AxisOrder::yxz));
    stack.push_back({std::move(chunk), 0});
  }
  const VoxelBox all{{chunk_x * edge, box_.min.y, chunk_z * edge},
                     {chunk_x * edge + edge, box_.max.y, chunk_z * edge + edge}};
  const VoxelBox part = intersect(box_, all);
  for (std::int32_t z = part.min.z; z < part.max.z; ++z) {
    for (std::int32_t x = part.min.x; x < part.max.x; ++x) {
      const auto line = static_cast<std::uint32_t>((x - all.min.x) + edge * (z - all.min.z));
      const std::size_t first = runs_.size();
      for (std::int32_t y = low; y <= high; ++y) {
        append_line(stack[static_cast<std::size_t>(y - low)],
                    line * static_cast<std::uint32_t>(edge), y * edge,
                    std::max(y * edge, box_.min.y), std::min(y * edge + edge, box_.max.y), first,
                    runs_);
      }
      spans_[index(x, z)] = {first, runs_.size() - first};
    }
  }
}

Material material_in_column(std::span<const ColumnRun> column, std::int32_t y) {
  const auto run = std::upper_bound(column.begin(), column.end(), y,
                                    [](std::int32_t at, const ColumnRun& r) { return at < r.end; });
  RUNSTONE_DASSERT(run != column.end());
  return run->material;
}

}  // namespace runstone
