#include "client/map/map_tile.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace runstone {
namespace {

/// How much lighter a slope of one voxel a column is, and the steepest slope that makes a
/// difference.
constexpr double kRelief = 0.11;
constexpr double kSlopeMax = 3;
/// The share of light that a transparent material of alpha 255 would take in each voxel.
constexpr double kDimPerVoxel = 0.35;
/// A deep view ends after this many voxels.
constexpr std::int32_t kDepthMax = 48;

using Colour = std::array<double, 3>;

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
Colour column_colour(const ColumnTop& surface, const ColumnTop& ground,
                     const MapMaterials& materials) {
  const MaterialColour top = materials.colour(surface.material);
  if (surface == ground) return rgb(top);
  const std::int32_t depth =
      ground.is_found() ? std::min(kDepthMax, surface.y - ground.y) : kDepthMax;
  const double kept = std::pow(1 - kDimPerVoxel * top[3] / 255.0, depth);
  const Colour below = ground.is_found() ? rgb(materials.colour(ground.material)) : rgb(top);
  Colour out = rgb(top);
  // Deeper is darker as well, so that a lake has a shape.
  const double dark = 1 - 0.35 * static_cast<double>(depth) / kDepthMax;
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = out[i] * dark * (1 - kept) + below[i] * kept;
  return out;
}

/// Returns true if a chunk of one material shows nothing from above.
bool is_invisible(const RunChunk& chunk, const MapMaterials& materials) {
  if (!chunk.is_uniform()) return false;
  const std::size_t material = chunk.runs.material(0);
  return material < materials.showing.size() && !materials.showing[material] &&
         material < materials.ground.size() && !materials.ground[material];
}

std::vector<std::int32_t> border_heights(const MapTile* tile) {
  std::vector<std::int32_t> out;
  if (tile == nullptr) return out;
  for (std::int32_t i = 0; i < tile->edge; ++i) {
    out.push_back(tile->at(tile->edge - 1, i).y);
    out.push_back(tile->at(i, tile->edge - 1).y);
  }
  return out;
}

}  // namespace

std::size_t MapTile::bytes() const {
  return (surface.size() + ground.size()) * sizeof(ColumnTop) +
         (image == nullptr ? 0 : image->pixels.size() * sizeof(std::uint32_t));
}

MapTile make_map_tile(std::span<const StackedChunk> chunks, std::int32_t edge,
                      const MapMaterials& materials, std::size_t& work) {
  const auto columns = static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge);
  MapTile out{edge, std::vector<ColumnTop>(columns), std::vector<ColumnTop>(columns), nullptr};
  std::size_t surface_open = columns, ground_open = columns;
  for (const StackedChunk& chunk : chunks) {
    if (ground_open == 0) break;
    if (is_invisible(*chunk.voxels, materials)) {
      ++work;
      continue;
    }
    work += chunk.voxels->runs.size() + columns;
    if (surface_open != 0)
      surface_open -= find_column_tops(*chunk.voxels, chunk.base_y, materials.showing, out.surface);
    ground_open -= find_column_tops(*chunk.voxels, chunk.base_y, materials.ground, out.ground);
  }
  return out;
}

std::shared_ptr<const OverlayImage> paint_map_tile(const MapTile& tile, const MapTile* west,
                                                   const MapTile* north,
                                                   const MapMaterials& materials) {
  const std::int32_t edge = tile.edge;
  auto image = std::make_shared<OverlayImage>();
  image->width = image->height = edge;
  image->pixels.reserve(tile.surface.size());
  const auto rise = [](const ColumnTop& here, const ColumnTop& beside) {
    if (!here.is_found() || !beside.is_found()) return 0.0;
    return std::clamp(static_cast<double>(here.y) - beside.y, -kSlopeMax, kSlopeMax);
  };
  for (std::int32_t z = 0; z < edge; ++z) {
    for (std::int32_t x = 0; x < edge; ++x) {
      const ColumnTop& here = tile.at(x, z);
      if (!here.is_found()) {
        image->pixels.push_back(0);  // transparent: nothing is known, or nothing is there
        continue;
      }
      double slope = 0;
      if (x > 0 || west != nullptr)
        slope += rise(here, x > 0 ? tile.at(x - 1, z) : west->at(edge - 1, z));
      if (z > 0 || north != nullptr)
        slope += rise(here, z > 0 ? tile.at(x, z - 1) : north->at(x, edge - 1));
      const ColumnTop& ground = tile.ground[static_cast<std::size_t>(x + edge * z)];
      image->pixels.push_back(packed(column_colour(here, ground, materials), 1 + kRelief * slope));
    }
  }
  return image;
}

bool has_other_border(const MapTile* before, const MapTile* after) {
  return border_heights(before) != border_heights(after);
}

}  // namespace runstone
