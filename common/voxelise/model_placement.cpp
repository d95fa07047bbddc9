#include "common/voxelise/model_placement.hpp"

#include <algorithm>
#include <cmath>

namespace runstone {
namespace {

struct ModelBounds {
  std::array<double, 3> low{}, high{};
};

ModelBounds bounds_of(const Model& model) {
  std::array<float, 3> low =
      model.positions[model.is_cloud() ? 0 : std::size_t{model.triangles[0][0]}];
  std::array<float, 3> high = low;
  const auto add = [&](const std::array<float, 3>& position) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], position[i]);
      high[i] = std::max(high[i], position[i]);
    }
  };
  if (model.is_cloud()) {
    for (const auto& position : model.positions) add(position);
  } else {
    for (const auto& triangle : model.triangles) {
      for (const std::uint32_t vertex : triangle) add(model.positions[vertex]);
    }
  }
  return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

}  // namespace

Result<ModelPlacement> ModelPlacement::of(const Model& model, const Orientation& turn,
                                          const VoxelScale& scale) {
  if ((scale.longest_side != 0) == (scale.voxels_per_unit != 0))
    return fail(ErrorCode::bad_value,
                "scale: give either the voxels of the longest side or the voxels per unit");
  if (scale.longest_side > static_cast<std::uint32_t>(kVoxeliseSideMax))
    return fail(ErrorCode::limit_exceeded, "scale: the longest side must be 1 .. 4,096 voxels");
  if (scale.longest_side == 0 &&
      !(scale.voxels_per_unit > 0 && std::isfinite(scale.voxels_per_unit)))
    return fail(ErrorCode::bad_value, "scale: the voxels per unit must be above 0");
  const ModelBounds bounds = bounds_of(model);
  double longest = 0;
  for (std::size_t i = 0; i < 3; ++i) longest = std::max(longest, bounds.high[i] - bounds.low[i]);
  double units = scale.voxels_per_unit * kVoxelUnit;
  if (scale.longest_side != 0)
    units = longest == 0 ? 0 : double{1} * scale.longest_side * kVoxelUnit / longest;
  if (!(longest * units <= (kVoxeliseSideMax + 0.001) * kVoxelUnit))
    return fail(ErrorCode::limit_exceeded,
                "the model becomes longer than 4,096 voxels: choose a smaller scale");
  ModelPlacement out;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const auto source = static_cast<unsigned>(turn.along(static_cast<Axis>(axis)));
    const bool reversed = turn.flipped(static_cast<Axis>(axis));
    out.along_[axis] = {source, reversed ? bounds.high[source] : bounds.low[source],
                        reversed ? -units : units};
    const auto length = static_cast<std::int32_t>(
        (bounds.high[source] - bounds.low[source]) * std::abs(units) + 0.5);
    out.sides_[axis] = std::clamp((length + kVoxelUnit - 1) / kVoxelUnit, 1, kVoxeliseSideMax);
  }
  return out;
}

}  // namespace runstone
