#include "common/map/map_painter.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

/// How much lighter a slope of one voxel a column is, and the steepest slope that makes a
/// difference.
constexpr double kRelief = 0.11;
constexpr std::int32_t kSlopeMax = 3;
/// The share of light that a transparent material of alpha 255 would take in each voxel.
constexpr double kDimPerVoxel = 0.35;
/// A deep view ends after this many voxels.
constexpr std::int32_t kDepthMax = 48;

using Colour = std::array<double, 3>;

/// All that the colour of a pixel depends on.
struct PixelKey {
  Material top = kEmpty, ground = kEmpty;
  std::uint8_t depth = 0;  // from the surface to the ground, at most kDepthMax
  std::int8_t slope = 0;   // to the west and to the north together
  bool has_ground = false;

  std::uint64_t bits() const {
    return std::uint64_t{top} | std::uint64_t{ground} << 16 | std::uint64_t{depth} << 32 |
           std::uint64_t{static_cast<std::uint8_t>(slope)} << 40 | std::uint64_t{has_ground} << 48;
  }
};

Colour rgb(const MaterialColour& colour) {
  return {static_cast<double>(colour[0]), static_cast<double>(colour[1]),
          static_cast<double>(colour[2])};
}

std::uint32_t packed(const Colour& colour, double factor) {
  std::uint32_t out = 0xFF000000U;
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = std::clamp(colour[i] * factor, 0.0, 255.0);
    out |= static_cast<std::uint32_t>(std::lround(value)) << (8 * i);
  }
  return out;
}

/// Returns the colour of a column: that of its ground through what lies above.
Colour column_colour(const PixelKey& key, const MapMaterials& materials) {
  const MaterialColour top = materials.colour(key.top);
  if (key.has_ground && key.depth == 0) return rgb(top);
  const double kept = std::pow(1 - kDimPerVoxel * top[3] / 255.0, key.depth);
  const Colour below = key.has_ground ? rgb(materials.colour(key.ground)) : rgb(top);
  Colour out = rgb(top);
  // Deeper is darker as well, so that a lake has a shape.
  const double dark = 1 - 0.35 * key.depth / kDepthMax;
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = out[i] * dark * (1 - kept) + below[i] * kept;
  return out;
}

std::int32_t rise(const ColumnTop& here, const ColumnTop& beside) {
  if (!here.is_found() || !beside.is_found()) return 0;
  return static_cast<std::int32_t>(
      std::clamp<std::int64_t>(std::int64_t{here.y} - beside.y, -kSlopeMax, kSlopeMax));
}

PixelKey key_of(const ColumnTop& here, const ColumnTop& ground, std::int32_t slope,
                std::int32_t unit) {
  PixelKey key;
  key.top = here.material;
  key.has_ground = ground.is_found();
  key.ground = key.has_ground ? ground.material : kEmpty;
  const std::int64_t depth = key.has_ground ? (std::int64_t{here.y} - ground.y) * unit : kDepthMax;
  key.depth = static_cast<std::uint8_t>(std::min<std::int64_t>(depth, kDepthMax));
  key.slope = static_cast<std::int8_t>(slope);
  return key;
}

/// Returns the upper ten bits of a product with an odd number: multiplicative hashing.
std::size_t slot_of(std::uint64_t bits) {
  return static_cast<std::size_t>(bits * 0x9e3779b97f4a7c15ULL >> 54);
}

}  // namespace

MapPainter::MapPainter(const MapMaterials& materials, std::int32_t unit)
    : materials_(materials), unit_(unit), kept_(kSlots) {}

void MapPainter::paint(const MapTops& tops, std::span<const ColumnTop> west,
                       std::span<const ColumnTop> north, std::span<std::uint32_t> out,
                       std::size_t stride) {
  const auto edge = static_cast<std::size_t>(tops.edge);
  RUNSTONE_ASSERT(west.empty() || west.size() == edge);
  RUNSTONE_ASSERT(north.empty() || north.size() == edge);
  RUNSTONE_ASSERT(edge == 0 || (stride >= edge && out.size() >= (edge - 1) * stride + edge));
  const std::span<const ColumnTop> all_ground = tops.ground_or_surface();
  for (std::size_t z = 0; z < edge; ++z) {
    const ColumnTop* row = tops.surface.data() + z * edge;
    const ColumnTop* ground = all_ground.data() + z * edge;
    const ColumnTop* above = z > 0 ? row - edge : north.empty() ? nullptr : north.data();
    std::uint32_t* pixels = out.data() + z * stride;
    for (std::size_t x = 0; x < edge; ++x) {
      const ColumnTop& here = row[x];
      if (!here.is_found()) {
        pixels[x] = 0;  // nothing is known, or nothing is there
        continue;
      }
      std::int32_t slope = 0;
      if (x > 0) {
        slope = rise(here, row[x - 1]);
      } else if (!west.empty()) {
        slope = rise(here, west[z]);
      }
      if (above != nullptr) slope += rise(here, above[x]);
      const PixelKey key = key_of(here, ground[x], slope, unit_);
      const std::uint64_t bits = key.bits();
      Kept& kept = kept_[slot_of(bits)];
      if (kept.bits != bits)
        kept = {bits, packed(column_colour(key, materials_), 1 + kRelief * slope)};
      pixels[x] = kept.pixel;
    }
  }
}

std::vector<std::uint32_t> paint_map(const MapTops& tops, std::span<const ColumnTop> west,
                                     std::span<const ColumnTop> north,
                                     const MapMaterials& materials, std::int32_t unit) {
  std::vector<std::uint32_t> pixels(tops.surface.size());
  MapPainter(materials, unit).paint(tops, west, north, pixels, static_cast<std::size_t>(tops.edge));
  return pixels;
}

}  // namespace runstone
