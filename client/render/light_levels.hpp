// LightLevels: the light of a voxel: red, green, blue and sky in one byte each, 0 .. kLightMax. A
// step to a neighbour takes a fixed amount from all four, so light spreads by saturated subtraction
// and maximum. Bit 7 of each byte is free, which lets one 32-bit operation act on all four. Pure.
#pragma once
#include <algorithm>
#include <cstdint>

#include "client/render/light_code.hpp"

namespace runstone {

/// Bits 0 to 7 are red, 8 to 15 green, 16 to 23 blue, 24 to 31 sky.
using LightLevels = std::uint32_t;

inline constexpr std::uint32_t kLightMax = 120;
/// The loss of light in a step: over a face, and over an edge between two voxels. 11 / 8 is nearly
/// the square root of 2, so light spreads almost in spheres.
inline constexpr std::uint32_t kFaceStep = 8, kEdgeStep = 11;
/// Light reaches this many voxels.
inline constexpr int kLightReach = kLightMax / kFaceStep;

/// The loss of light that comes into a voxel, besides that of the step. Requires that it is not
/// opaque.
constexpr std::uint32_t loss_of(LightPass pass) {
  return pass == LightPass::liquid ? 4 : pass == LightPass::leaves ? 14 : 0;
}

constexpr LightLevels emission_levels(LightCode code) {
  return emission_of(code, 0) * 8 | emission_of(code, 1) * 8 << 8 | emission_of(code, 2) * 8 << 16;
}

/// Returns max(level - loss, 0) for each byte. Requires levels and loss of at most 127.
constexpr LightLevels dimmed(LightLevels levels, std::uint32_t loss) {
  constexpr std::uint32_t kHigh = 0x80808080U;
  const std::uint32_t difference = (levels | kHigh) - loss * 0x01010101U;
  const std::uint32_t no_borrow = difference & kHigh;
  return difference & (no_borrow - (no_borrow >> 7));
}

/// Returns the greater of both for each byte. Requires levels of at most 127.
constexpr LightLevels brighter(LightLevels a, LightLevels b) {
  constexpr std::uint32_t kHigh = 0x80808080U;
  const std::uint32_t no_borrow = ((a | kHigh) - b) & kHigh;
  const std::uint32_t from_a = no_borrow - (no_borrow >> 7);
  return (a & from_a) | (b & ~from_a);
}

constexpr std::uint32_t sky_of(LightLevels levels) { return levels >> 24; }
constexpr std::uint32_t brightest_of(LightLevels levels) {
  return std::max({levels & 255U, levels >> 8 & 255U, levels >> 16 & 255U, levels >> 24});
}

}  // namespace runstone
