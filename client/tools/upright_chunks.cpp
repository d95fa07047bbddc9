#include "client/tools/upright_chunks.hpp"

#include "common/runs/reorder.hpp"

namespace runstone {

void UprightChunks::begin_plan() {
  std::erase_if(kept_, [this](const auto& entry) { return entry.second.used != plan_; });
  ++plan_;
}

std::shared_ptr<const RunChunk> UprightChunks::of(const std::shared_ptr<const RunChunk>& chunk) {
  if (chunk->order == AxisOrder::yxz || chunk->is_uniform()) return chunk;
  const auto found = kept_.find(chunk.get());
  if (found != kept_.end()) {
    found->second.used = plan_;
    return found->second.upright;
  }
  auto upright = std::make_shared<const RunChunk>(reorder(*chunk, AxisOrder::yxz));
  if (kept_.size() < kKeptMax) kept_[chunk.get()] = {chunk, upright, plan_};
  return upright;
}

}  // namespace runstone
