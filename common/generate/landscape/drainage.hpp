// Drainage: where water flows in a landscape. Each square of kDrainageWidth voxels has one node,
// which drains into its lowest neighbour. So the way of the water follows from the heights around
// each node alone, and each part of the world can be made without the others.
// Source: Gaillard et al., Dendry: A Procedural Model for Dendritic Patterns (I3D 2019).
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "common/generate/landscape/lattice_noise.hpp"
#include "common/generate/landscape/recent.hpp"
#include "common/generate/landscape/square_key.hpp"

namespace runstone {

inline constexpr unsigned kDrainageBits = 10;
inline constexpr std::int32_t kDrainageWidth = 1 << kDrainageBits;
/// Beyond this distance a watercourse has no effect on the ground, in voxels. Every place has a
/// node within sqrt(2) * 3/4 of a square's width.
inline constexpr std::int32_t kDrainageReach = 1280;

/// The bottom of a valley from one node to the next, with or without a river, or a lake around a
/// node. Lengths are sixteenths of a voxel. Places are relative to the square that holds the list.
struct Watercourse {
  std::int32_t x, z, to_x, to_z;          // to_*: the end, relative to the start
  std::int64_t inverse;                   // 2^44 / length^2, or 0 for a lake
  std::int32_t level, to_level;           // at both ends, in voxels
  std::int32_t plateau, plateau_inverse;  // the share of the way before the level begins to fall
  std::int32_t half_width, to_half_width;
  bool is_wet;
  bool is_lake;
};

/// A place on a watercourse.
struct WatercoursePoint {
  std::int64_t distance_squared;  // from the middle line
  std::int32_t half_width;
  std::int32_t level;  // in 256ths of a voxel
};

/// Returns the point of the watercourse that is nearest to (x, z), both relative to the square.
WatercoursePoint nearest_point(const Watercourse& course, std::int32_t x, std::int32_t z);

/// The watercourses that have an effect on a square.
using DrainageSquare = std::vector<Watercourse>;

class Drainage {
 public:
  explicit Drainage(std::uint64_t seed);

  /// Returns the square with the number (x, z): it begins at the voxel x * kDrainageWidth. Thread:
  /// any. Cost: O(1), about 0.1 ms unless the square is kept.
  std::shared_ptr<const DrainageSquare> square(std::int32_t x, std::int32_t z) const;

  /// Returns how much of a mountain range the place is, 0 .. kOne. Continents have them inland.
  std::int32_t mountain_share(std::int32_t x, std::int32_t z) const;
  /// Returns a number of the place that is above 0 on land, within about -kOne .. kOne.
  std::int32_t continent(std::int32_t x, std::int32_t z) const;

 private:
  struct Node {
    std::int32_t x, z;  // in voxels
    std::int32_t level;
    std::uint64_t random;
  };
  Node node(std::int32_t i, std::int32_t k) const;
  std::int32_t mountain_share(std::int32_t x, std::int32_t z, std::int32_t land) const;
  DrainageSquare make(std::int32_t x, std::int32_t z) const;

  std::uint64_t key_;
  LatticeNoise continent_14_, continent_13_, continent_12_, continent_11_;
  LatticeNoise range_13_, range_12_, ranges_14_;
  mutable Recent<SquareKey, DrainageSquare> squares_;
};

}  // namespace runstone
