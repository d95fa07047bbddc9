// ModelChoices: what a person chooses when a file with a model becomes a build (docs/models.md).
// Programs, commands, scripts and windows have the same choices. Plain data. Thread: any.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/models/model_format.hpp"
#include "common/models/surface_mode.hpp"

namespace runstone {

inline constexpr std::uint32_t kModelVoxelsUsual = 128;
inline constexpr std::int64_t kModelVoxelsMax = 4096;
inline constexpr std::string_view kModelVoxelsRange = "a whole number from 1 to 4096";
/// The range of ModelChoices::voxels_per_metre.
inline constexpr double kVoxelsPerMetreMin = 1e-6, kVoxelsPerMetreMax = 1e6;
inline constexpr std::string_view kVoxelsPerMetreRange = "a number from 0.000001 to 1000000";

struct ModelChoices {
  /// Voxels of the longest side, 1 .. kModelVoxelsMax.
  std::uint32_t voxels = kModelVoxelsUsual;
  /// In place of `voxels`. In a format without units a unit is a metre.
  std::optional<double> voxels_per_metre = std::nullopt;
  /// The inside is filled. A model that is no closed surface is filled by its winding number.
  bool is_solid = true;
  /// The surface that is set besides the inside. It keeps walls in which no voxel has its centre. A
  /// closed model becomes no thicker by a thin one, and up to a voxel by the others. If it is
  /// unset, a solid model gets no surface. A hollow model, and one in which no voxel is inside,
  /// then gets a thin one.
  std::optional<SurfaceMode> surface = std::nullopt;
  /// Where closed parts overlap, the inside is filled, too.
  bool fills_overlaps = false;
  /// The axis of the file that points up. Unset: usual_up() of its format.
  std::optional<ModelUp> up = std::nullopt;
  /// Quarter turns about the axis that points up, 0 .. 3, to the left as seen from above.
  int quarters = 0;

  friend bool operator==(const ModelChoices&, const ModelChoices&) = default;
};

/// Returns why a number of voxels of the longest side is none, such as "a whole number from 1 to
/// 4096 is expected", or an empty text.
std::string voxels_refusal(std::int64_t voxels);
/// Returns why a number of voxels of a metre is none, or an empty text.
std::string voxels_per_metre_refusal(double voxels_per_metre);
/// Returns why choices contradict each other, or an empty text.
std::string choices_refusal(const ModelChoices& choices);

}  // namespace runstone
