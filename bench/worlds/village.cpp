#include "bench/worlds/village.hpp"

#include <array>
#include <string_view>

#include "bench/worlds/seeded_worlds.hpp"
#include "bench/worlds/town.hpp"
#include "common/core/hash.hpp"
#include "common/shapes/shape_kinds.hpp"

namespace runstone::bench {
namespace {

struct VillageShape {
  std::string_view kind, states;
  Visibility visibility = Visibility::opaque;
};

/// The materials with shapes, from kFirstShape on.
constexpr std::array<VillageShape, 18> kVillageShapes = {{
    {"pane", "east=true,west=true", Visibility::transparent},
    {"pane", "north=true,south=true", Visibility::transparent},
    {"stairs", "facing=north"},
    {"stairs", "facing=east"},
    {"stairs", "facing=south"},
    {"stairs", "facing=west"},
    {"stairs", "facing=north,half=top"},
    {"stairs", "facing=east,half=top"},
    {"slab", "type=bottom"},
    {"slab", "type=top"},
    {"fence", "east=true,west=true"},
    {"fence", "north=true,south=true"},
    {"fence", "north=true,east=true"},
    {"fence", ""},
    {"carpet", ""},
    {"plant", ""},
    {"trapdoor", "half=bottom,open=false"},
    {"torch", ""},
}};
constexpr Material kFirstShape = static_cast<Material>(Block::tiles) + 1;

constexpr Material shape(unsigned number) { return static_cast<Material>(kFirstShape + number); }

constexpr std::int32_t kVillageLot = 16;

/// Returns the stairs of a roof that rises towards the middle of the lot.
Material roof_stairs(std::int32_t x, std::int32_t z) {
  const std::int32_t dx = x - 9, dz = z - 9;
  const std::int32_t ax = dx < 0 ? -dx : dx, az = dz < 0 ? -dz : dz;
  if (ax > az) return shape(dx < 0 ? 3 : 5);
  return shape(dz < 0 ? 4 : 2);
}

std::uint64_t dice(std::int32_t x, std::int32_t y, std::int32_t z) {
  const auto bits = [](std::int32_t v) { return std::uint64_t{static_cast<std::uint32_t>(v)}; };
  return mix64(bits(x) << 40 ^ bits(y) << 20 ^ bits(z));
}

}  // namespace

void village_column(VoxelPos at, std::span<Material> out) {
  std::vector<Material> town(out.size() + 1);
  town_column(at, town);
  const std::int32_t x = at.x - floor_div(at.x, kVillageLot) * kVillageLot;
  const std::int32_t z = at.z - floor_div(at.z, kVillageLot) * kVillageLot;
  const bool is_house = x >= 4 && x <= 14 && z >= 4 && z <= 14;
  const bool is_wall = is_house && (x == 4 || x == 14 || z == 4 || z == 14);
  const bool is_fence = (x == 3 && z >= 3) || (z == 3 && x >= 3);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::int32_t y = at.y + static_cast<std::int32_t>(i);
    const auto block = static_cast<Block>(town[i]);
    out[i] = town[i];
    const std::uint64_t random = dice(at.x, y, at.z);
    if (block == Block::glass) {
      out[i] = shape(x == 4 || x == 14 ? 1 : 0);
    } else if (block == Block::tiles && town[i + 1] == kEmpty) {
      out[i] = is_wall ? roof_stairs(x, z) : random % 3 == 0 ? shape(8) : roof_stairs(x, z);
    } else if (block == Block::air && y == 0 && is_fence) {
      out[i] = x == 3 && z == 3 ? shape(12) : shape(x == 3 ? 11 : 10);
    } else if (block == Block::air && y == 0 && !is_house && random % 12 == 0) {
      out[i] = shape(15);
    } else if (block == Block::air && is_house && !is_wall && y >= 0 && y < 20 && y % 4 == 1) {
      // Furniture stands along the walls, and a carpet lies between.
      const bool is_beside_wall = x == 5 || x == 13 || z == 5 || z == 13;
      constexpr std::array<unsigned, 6> kFurniture = {2, 3, 13, 16, 17, 9};
      if (is_beside_wall && random % 8 == 0) {
        out[i] = shape(kFurniture[random / 8 % kFurniture.size()]);
      } else if (y == 1 && x > 6 && x < 12 && z > 6 && z < 12) {
        out[i] = shape(14);
      }
    }
  }
}

std::vector<Visibility> village_visibilities() {
  std::vector<Visibility> out = visibilities(seeded_materials());
  for (const VillageShape& of : kVillageShapes) out.push_back(of.visibility);
  return out;
}

std::vector<Shape> village_shapes() {
  std::vector<Shape> out(kFirstShape);
  for (const VillageShape& of : kVillageShapes)
    out.push_back(shape_of_kind(of.kind, of.states).value());
  return out;
}

}  // namespace runstone::bench
