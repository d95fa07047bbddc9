// Far reach: how far a view with tiles reaches, in voxels.
#pragma once
#include <cmath>
#include <cstdint>

#include "protocol/codec/view_tiles.hpp"

namespace runstone {

/// The far plane lies a tenth farther, within the 32,768 voxels up to which depth separates faces a
/// voxel apart (client/render/depth_range.hpp).
inline constexpr double kReachMax = 29'000;

/// Returns the distance within which the view has ground in all directions, or 0 if it has no
/// tiles. The eye is anywhere in the tile of the centre, so the disc of the highest level ends up
/// to half a tile before its radius.
inline double far_reach(const View& view, std::int32_t chunk_edge) {
  const std::uint8_t levels = tile_levels(view);
  if (levels == 0) return 0;
  const double reach = (view.radius_h - 0.5) * std::ldexp(chunk_edge, levels);
  return reach < kReachMax ? reach : kReachMax;
}

/// Returns the most levels, up to `wanted`, of which each adds ground within kReachMax.
inline std::uint8_t useful_levels(std::uint8_t radius_h, std::int32_t chunk_edge,
                                  std::uint8_t wanted) {
  std::uint8_t levels = 0;
  for (; levels < wanted; ++levels) {
    if ((radius_h - 0.5) * std::ldexp(chunk_edge, levels) >= kReachMax) break;
  }
  return levels;
}

}  // namespace runstone
