// Scattering: places on the ground at random, but never too close together.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/sculpt/ground_columns.hpp"
#include "common/sculpt/ground_surface.hpp"

namespace runstone {

/// The places of one scattering, at most.
inline constexpr std::size_t kScatteredMax = 1024;

struct Scattering {
  std::int32_t radius = 16;  // voxels around the stroke, 1 .. kBrushRadiusMax
  std::int32_t spacing = 6;  // voxels between the middles of two places, at least 1
  std::uint64_t seed = 1;
};

struct ScatteredSpot {
  VoxelPos ground;            // the highest voxel of ground
  std::uint8_t quarters = 0;  // a turn at random, 0 .. 3
  friend bool operator==(const ScatteredSpot&, const ScatteredSpot&) = default;
};

/// Returns the box that scattered_spots() reads for a stroke through these voxels of the surface.
VoxelBox scatter_box(const Scattering& scattering, std::span<const VoxelPos> places);

/// Returns places up to the radius from the stroke, in the order of their cells: by x, then by z.
/// It returns at most kScatteredMax + 1 of them; more than kScatteredMax means that there are too
/// many. Each cell of a lattice whose side is twice the spacing has at most one place. The place
/// depends on the seed and the cell alone and keeps the spacing, so a stroke over the same ground
/// finds the same places. A column with any voxel above its ground is left out. Cost: O(runs +
/// cells).
std::vector<ScatteredSpot> scattered_spots(const GroundColumns& columns,
                                           const GroundMaterials& materials,
                                           const Scattering& scattering,
                                           std::span<const VoxelPos> places);

}  // namespace runstone
