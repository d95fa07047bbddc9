// Beam: the voxels of 64 x 64 rows along x, made from the triangles that meet them. It is the unit
// of work of the voxeliser. Rows are lists of crossings and of voxels on the surface, sorted; there
// is no grid. Internal to this room.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/core/coords.hpp"
#include "common/materials/colour_quantiser.hpp"
#include "common/voxelise/model_colours.hpp"
#include "common/voxelise/model_placement.hpp"
#include "common/voxelise/open_winding.hpp"
#include "common/voxelise/voxelise.hpp"

namespace runstone {

/// The side of the sections that the voxeliser makes.
inline constexpr std::int32_t kVoxelSection = 64;

/// The data that all beams of a model share.
struct BeamPlan {
  const Model* model = nullptr;
  const ModelPlacement* placement = nullptr;
  const ModelColours* colours = nullptr;
  const OpenWinding* winding = nullptr;  // null: by parity
  bool is_solid = false;
  SurfaceMode surface = SurfaceMode::none;
  std::int64_t radius = 0;  // units, of the points of a cloud
  /// Null in the first walk, which counts colours. Unused if the model has only one colour.
  const ColourQuantiser* quantiser = nullptr;
};

struct BeamResult {
  std::vector<VoxelPiece> pieces;  // along x; none in the walk that counts colours
  std::vector<std::pair<VoxelRgb, std::uint64_t>> colours;  // only in that walk; ascending
  std::uint64_t voxels = 0;
  bool is_too_much = false;     // of work; then the rest is not complete
  bool holds_too_much = false;  // of memory; then the rest is not complete
};

/// Makes the beam with the lowest row (y, z), multiples of kVoxelSection. `parts` are the
/// triangles, or the points of a cloud, that meet it; others may be among them. Thread: any.
/// Deterministic.
BeamResult make_beam(const BeamPlan& plan, std::int32_t y, std::int32_t z,
                     std::span<const std::uint32_t> parts);

}  // namespace runstone
