// VoxelBuild: a model as a build, with materials for its colours.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "common/builds/build.hpp"
#include "common/core/material_row.hpp"
#include "common/core/result.hpp"
#include "common/models/model.hpp"
#include "common/voxelise/voxelise.hpp"

namespace runstone {

struct VoxelBuild {
  BuildPtr
      build;  // material i + 1 is that of materials[i], so its palette names them by these numbers
  std::vector<MaterialRow> materials;
  Voxelised result;
};

/// Returns the name of the material of a colour, "colour #rrggbb", as files of colours without
/// names give it (.vox, height maps).
std::string colour_material_name(const std::array<std::uint8_t, 3>& colour);

/// Voxelises a model into a build, cut at multiples of 64. Voxels outside the result are untouched.
/// Fails as voxelise() does, with limit_exceeded if the build takes more than `bytes_max`, and with
/// bad_value if no voxel is set.
Result<VoxelBuild> voxel_build(const Model& model, const VoxeliseOptions& options,
                               std::size_t bytes_max = kBuildBytesMax,
                               const ParallelFor& parallel_for = {});

}  // namespace runstone
