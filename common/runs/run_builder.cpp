#include "common/runs/run_builder.hpp"

#include <utility>

namespace runstone {

RunBuilder::RunBuilder(Extent extent, AxisOrder order)
    : chunk_{extent, order, RunList{extent.volume()}} {
  RUNSTONE_ASSERT(extent.valid_part());
}

void RunBuilder::append(std::uint32_t count, Material material) {
  if (count == 0) return;
  RUNSTONE_DASSERT(count <= chunk_.volume() - filled_);
  if (filled_ != 0 && material != open_) flush();
  open_ = material;
  filled_ += count;
}

void RunBuilder::flush() { chunk_.runs.push_back({filled_, open_}); }

RunChunk RunBuilder::finish() {
  RUNSTONE_ASSERT(filled_ == chunk_.volume());
  flush();
  filled_ = 0;
  RunChunk out = std::move(chunk_);
  // The list was moved from but keeps the form that the volume requires.
  chunk_.runs.clear();
  return out;
}

}  // namespace runstone
