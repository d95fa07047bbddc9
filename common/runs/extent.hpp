// Extent: the sides of a cuboid of voxels. World chunks are cubes; the library also takes other
// cuboids.
#pragma once
#include <array>
#include <compare>
#include <cstdint>

namespace runstone {

inline constexpr unsigned kSideMin = 8;
inline constexpr unsigned kSideMax = 128;

/// Index of a voxel in its flattened chunk, in the chunk's own axis order.
using VoxelIndex = std::uint32_t;

struct Extent {
  std::uint8_t x = 32, y = 32, z = 32;  // voxels; of a chunk kSideMin .. kSideMax each
  friend auto operator<=>(const Extent&, const Extent&) = default;

  constexpr std::uint32_t volume() const {
    return static_cast<std::uint32_t>(x) * static_cast<std::uint32_t>(y) *
           static_cast<std::uint32_t>(z);
  }
  constexpr std::array<std::uint8_t, 3> sides() const { return {x, y, z}; }
  /// Returns true if a chunk may have this extent.
  constexpr bool valid() const { return sides_from(kSideMin); }
  /// Returns true if a cuboid that is no chunk may have this extent, such as a part of a chunk or a
  /// clipboard: sides 1 .. kSideMax.
  constexpr bool valid_part() const { return sides_from(1); }
  /// Requires an edge of 1 .. kSideMax. chunk_extent() (checked_runs.hpp) takes sides from data.
  static constexpr Extent cube(unsigned edge) {
    const auto side = static_cast<std::uint8_t>(edge);
    return {side, side, side};
  }

 private:
  constexpr bool sides_from(unsigned least) const {
    for (const unsigned side : sides()) {
      if (side < least || side > kSideMax) return false;
    }
    return true;
  }
};

inline constexpr std::uint32_t kVolumeMax = kSideMax * kSideMax * kSideMax;

}  // namespace runstone
