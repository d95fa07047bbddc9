// Caves of a landscape: tunnels that wind through the ground. A tunnel is an interval of heights in
// a column, so it becomes runs without a grid.
#pragma once
#include <array>
#include <cstdint>

#include "common/generate/landscape/lattice_noise.hpp"

namespace runstone {

inline constexpr std::size_t kTunnels = 2;  // in a column, at most

/// Empty heights of a column. Empty if from >= to.
struct Tunnel {
  std::int32_t from = 0, to = 0;
};

class Caves {
 public:
  explicit Caves(std::uint64_t seed);
  /// Returns the tunnels through the column, the lowest first. `surface` is the height of the
  /// ground without its grain, in voxels. A tunnel may reach the ground. Cost: six noises.
  std::array<Tunnel, kTunnels> at(std::int32_t x, std::int32_t z, std::int32_t surface) const;

 private:
  struct Layer {
    LatticeNoise wide, narrow, height;
  };
  std::array<Layer, kTunnels> layers_;
};

}  // namespace runstone
