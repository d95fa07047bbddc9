#include "common/models/model_choices.hpp"

namespace runstone {

std::string voxels_refusal(std::int64_t voxels) {
  if (voxels >= 1 && voxels <= kModelVoxelsMax) return "";
  return std::string(kModelVoxelsRange) + " is expected";
}

std::string voxels_per_metre_refusal(double voxels_per_metre) {
  if (voxels_per_metre >= kVoxelsPerMetreMin && voxels_per_metre <= kVoxelsPerMetreMax) return "";
  return std::string(kVoxelsPerMetreRange) + " is expected";
}

std::string choices_refusal(const ModelChoices& choices) {
  if (choices.is_solid || choices.surface.value_or(SurfaceMode::separating_6) != SurfaceMode::none)
    return "";
  return "neither its inside nor its surface is wanted";
}

}  // namespace runstone
