#include "common/model_writers/model_levels.hpp"

#include <utility>

#include "common/core/assert.hpp"

namespace runstone {

namespace {

WrittenMaterial as_cube(WrittenMaterial material) {
  material.visibility = material.as_cube;
  material.shape = {};
  return material;
}

}  // namespace

Result<ModelLevels> ModelLevels::of(const WrittenBuild& source, const ModelWriting& writing) {
  RUNSTONE_ASSERT(writing.levels <= kModelLevelsMax);
  ModelLevels out;
  // A material of planes has both sides.
  out.walks_.emplace_back(source, writing, PlaneSides::one);
  const WrittenBuild* finer = &source;
  while (out.coarser_.size() < writing.levels && can_be_coarser(finer->build)) {
    auto made = coarser_build(*finer, finer->build.memory_bytes() + kBuildBytesMax);
    if (!made && made.error().code == ErrorCode::bad_value) break;  // it shows nothing
    if (!made) return failure(made.error());
    const Build& build = *made->build;
    Level level{*std::move(made), {build, source.info, {}}, {}};
    for (const std::uint16_t number : level.made.finer_numbers) {
      level.finest_numbers.push_back(out.finest_number(out.coarser_.size(), number));
      level.source.materials.push_back(as_cube(source.materials[level.finest_numbers.back() - 1U]));
    }
    out.coarser_.push_back(std::move(level));
    finer = &out.coarser_.back().source;
    out.walks_.emplace_back(*finer, writing, PlaneSides::one);
  }
  return out;
}

}  // namespace runstone
