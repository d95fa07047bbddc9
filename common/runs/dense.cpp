#include "common/runs/dense.hpp"

#include <algorithm>
#include <atomic>

#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

std::atomic<std::uint64_t> expansions{0};

}  // namespace

std::uint64_t dense_expansions() { return expansions.load(std::memory_order_relaxed); }
void count_dense_expansion() { expansions.fetch_add(1, std::memory_order_relaxed); }

std::vector<Material> to_dense(const RunChunk& chunk) {
  count_dense_expansion();
  std::vector<Material> out(chunk.volume());
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i < chunk.runs.size(); ++i) {
    const Run run = chunk.runs[i];
    std::fill(out.begin() + begin, out.begin() + run.end, run.material);
    begin = run.end;
  }
  return out;
}

Result<RunChunk> from_dense(Extent extent, AxisOrder order, std::span<const Material> voxels) {
  if (!extent.valid()) return fail(ErrorCode::bad_value, "chunk side outside 8..128");
  if (static_cast<std::uint8_t>(order) >= kAxisOrderCount)
    return fail(ErrorCode::bad_value, "unknown axis order");
  if (voxels.size() != extent.volume())
    return fail(ErrorCode::bad_value, "the number of voxels is not the volume of the chunk",
                voxels.size());
  RunBuilder builder(extent, order);
  for (const Material m : voxels) builder.append(1, m);
  return builder.finish();
}

}  // namespace runstone
