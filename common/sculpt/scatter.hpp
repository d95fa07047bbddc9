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
  std::int32_t radius = 16;  // voxels around the stroke, at least 1
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

/// Returns places up to the radius from the stroke, by x and then z, and at most kScatteredMax + 1.
/// Each cell of a lattice with a side of twice the spacing has at most one: at a place that only seed
/// and cell decide, in the half of the cell that keeps the spacing. So a stroke over the same ground
/// finds the same places. A place under a liquid or a tree is left out. Cost: O(runs + cells).
std::vector<ScatteredSpot> scattered_spots(const GroundColumns& columns,
                                           const GroundMaterials& materials,
                                           const Scattering& scattering,
                                           std::span<const VoxelPos> places);

}  // namespace runstone
