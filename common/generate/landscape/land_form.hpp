// LandForm: the shape and the climate of a landscape at single places. The ground rises from the
// bottoms of valleys (drainage.hpp) to the ridges between them. Between places of the lattice of
// kLandStep voxels, columns blend the four places around them, so near and far ground agree.
#pragma once
#include <array>
#include <cstdint>
#include <memory>

#include "common/generate/landscape/drainage.hpp"
#include "common/generate/landscape/lattice_noise.hpp"
#include "common/generate/landscape/recent.hpp"
#include "common/generate/landscape/square_key.hpp"

namespace runstone {

inline constexpr std::int32_t kLandStep = 8;
inline constexpr std::int32_t kPatchWidth = 64;  // voxels; a patch keeps the places of its square

/// Heights are 256ths of a voxel above the level of the sea, shares 0 .. kOne.
struct LandSample {
  std::int32_t height;          // of the ground without the bed of a river
  std::int32_t warp_x, warp_z;  // added to the place in the drainage, in sixteenths of a voxel
  std::int32_t shore;      // distance to the nearest river or lake, in sixteenths; below 0: inside
  std::int32_t water;      // the level of that river or lake, in voxels
  std::int32_t roughness;  // share: 0 in plains, kOne in a range
  std::int32_t forest;     // share of the ground below trees
  std::int32_t cold;       // voxels that the lines of trees and snow lie lower here
};

class LandForm {
 public:
  explicit LandForm(std::uint64_t seed);

  /// Returns the land at one place. Cost: about 1 us.
  LandSample at(std::int32_t x, std::int32_t z) const;

  static constexpr std::size_t kPatchSide = kPatchWidth / kLandStep;
  /// places[i + kPatchSide * k] is that of the voxel (kPatchWidth * x + kLandStep * i, ...).
  struct Patch {
    std::array<LandSample, kPatchSide * kPatchSide> places;
  };
  std::shared_ptr<const Patch> patch(std::int32_t x, std::int32_t z) const;

  /// Returns the square of the drainage that has a place, and the place relative to it.
  struct DrainagePlace {
    std::int32_t square_x, square_z;
    std::int32_t x, z;  // in sixteenths
  };
  static DrainagePlace drainage_place(std::int32_t x, std::int32_t z, std::int32_t warp_x,
                                      std::int32_t warp_z);
  const Drainage& drainage() const { return drainage_; }

 private:
  Drainage drainage_;
  std::array<LatticeNoise, 4> warp_x_, warp_z_;  // wavelengths 512, 256, 128, 64
  std::array<LatticeNoise, 4> crags_;            // wavelengths 512, 256, 128, 64
  LatticeNoise swell_8_, swell_7_, hills_11_, forest_10_, forest_8_, cold_11_;
  mutable Recent<SquareKey, Patch> patches_;
};

/// Heights above the sea that bound the ground of every landscape, in voxels.
inline constexpr std::int32_t kLandHeightMin = -96;
inline constexpr std::int32_t kLandHeightMax = 960;

}  // namespace runstone
