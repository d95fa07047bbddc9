#include "common/generate/spawn_point.hpp"

#include <cstdint>
#include <optional>

namespace runstone {
namespace {

constexpr std::int32_t kStep = 8;     // voxels between two columns that are tried
constexpr std::int32_t kRings = 128;  // of columns around the origin
constexpr std::int32_t kAboveSurface = 2;

class Columns {
 public:
  Columns(const Generator& generator, const MaterialTable& materials)
      : generator_(generator), materials_(materials) {}

  Visibility top(std::int32_t x, std::int32_t z) const {
    const VoxelPos at{x, generator_.surface_y(x, z) - 1, z};
    return materials_[material_at(generator_.generate(at, Extent::cube(1)), {0, 0, 0})].visibility;
  }
  bool is_land(std::int32_t x, std::int32_t z) const {
    const auto opaque = [&](std::int32_t dx, std::int32_t dz) {
      return top(x + dx, z + dz) == Visibility::opaque;
    };
    return opaque(0, 0) && opaque(kStep, 0) && opaque(-kStep, 0) && opaque(0, kStep) &&
           opaque(0, -kStep);
  }
  VoxelPos spawn_at(std::int32_t x, std::int32_t z) const {
    return {x, generator_.surface_y(x, z) + kAboveSurface, z};
  }

 private:
  const Generator& generator_;
  const MaterialTable& materials_;
};

/// Returns the land column of the ring that is nearest to the origin; the smallest x, then z, among
/// equally near ones.
std::optional<VoxelPos> nearest_on_ring(const Columns& columns, std::int32_t ring) {
  const std::int32_t side = ring * kStep;
  std::optional<VoxelPos> nearest;
  std::int64_t nearest_squared = 0;
  for (std::int32_t x = -side; x <= side; x += kStep) {
    const bool is_edge = x == -side || x == side;
    for (std::int32_t z = -side; z <= side; z += is_edge ? kStep : 2 * side) {
      const std::int64_t squared = std::int64_t{x} * x + std::int64_t{z} * z;
      if (nearest && squared >= nearest_squared) continue;
      if (!columns.is_land(x, z)) continue;
      nearest = columns.spawn_at(x, z);
      nearest_squared = squared;
    }
  }
  return nearest;
}

}  // namespace

bool is_origin_dry(const Generator& generator, const MaterialTable& materials) {
  return Columns(generator, materials).top(0, 0) != Visibility::transparent;
}

VoxelPos spawn_point(const Generator& generator, const MaterialTable& materials) {
  if (const auto chosen = generator.spawn()) return *chosen;
  const Columns columns(generator, materials);
  if (is_origin_dry(generator, materials)) return columns.spawn_at(0, 0);
  for (std::int32_t ring = 1; ring <= kRings; ++ring) {
    if (const auto found = nearest_on_ring(columns, ring)) return *found;
  }
  return columns.spawn_at(0, 0);
}

}  // namespace runstone
