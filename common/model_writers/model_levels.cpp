#include "common/model_writers/model_levels.hpp"

#include <utility>

#include "common/core/assert.hpp"

namespace runstone {

Result<ModelLevels> ModelLevels::of(const WrittenBuild& source, const ModelWriting& writing) {
  RUNSTONE_ASSERT(writing.levels <= kModelLevelsMax);
  ModelLevels out;
  out.walks_.emplace_back(source, writing);
  const WrittenBuild* finer = &source;
  while (out.coarser_.size() < writing.levels && can_be_coarser(finer->build)) {
    auto made = coarser_build(*finer, finer->build.memory_bytes() + kBuildBytesMax);
    if (!made) return failure(made.error());
    const Build& build = *made->build;
    Level level{*std::move(made), {build, source.info, {}}, {}};
    for (const std::uint16_t number : level.made.finer_numbers) {
      level.finest_numbers.push_back(out.finest_number(out.coarser_.size(), number));
      level.source.materials.push_back(source.materials[level.finest_numbers.back() - 1U]);
    }
    out.coarser_.push_back(std::move(level));
    finer = &out.coarser_.back().source;
    out.walks_.emplace_back(*finer, writing);
  }
  return out;
}

}  // namespace runstone
