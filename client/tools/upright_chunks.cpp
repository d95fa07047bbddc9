#include "client/tools/upright_chunks.hpp"

#include <utility>

#include "common/runs/reorder.hpp"

namespace runstone {

void UprightChunks::begin_plan() {
  std::erase_if(kept_, [this](const auto& entry) {
    if (entry.second.used == plan_) return false;
    runs_ -= entry.second.runs();
    return true;
  });
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
  Kept made{chunk, upright, plan_};
  const std::size_t runs = made.runs();
  if (runs <= runs_max_ - runs_) {
    runs_ += runs;
    kept_.emplace(chunk.get(), std::move(made));
  }
  return upright;
}

}  // namespace runstone
