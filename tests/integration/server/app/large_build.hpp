// The .rsb of a build that takes more than one part of the store.
#pragma once
#include <string>
#include <utility>

#include "common/core/hash.hpp"
#include "tests/support/formats/rsb_bytes.hpp"

namespace runstone::test {

inline Bytes large_build(const std::string& name) {
  SampleBuild build;
  build.info = sample_build_info({128, 64, 64});
  build.info.name = name;
  build.materials = sample_build_materials(200);
  SplitMix64 rng(7);
  for (std::uint32_t x = 0; x < 2; ++x) {
    RunChunk cells{Extent::cube(64), AxisOrder::xyz, RunList(kBuildSectionVolumeMax)};
    for (std::uint32_t end = 1, before = 0; end <= kBuildSectionVolumeMax; ++end) {
      const std::uint32_t number = (before + 1 + rng.below(200)) % 201;
      cells.runs.push_back({end, static_cast<Material>(number)});
      before = number;
    }
    build.sections.push_back({{x, 0, 0}, std::move(cells)});
  }
  return rsb_of(build, 0);
}

}  // namespace runstone::test
