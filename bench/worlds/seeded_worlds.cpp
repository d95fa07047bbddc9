#include "bench/worlds/seeded_worlds.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "bench/worlds/lattice_noise.hpp"
#include "bench/worlds/town.hpp"

namespace runstone::bench {
namespace {

/// A height map: the ground is the first empty voxel of a column. 62 x 62 x 62 voxels of the gentle
/// map in three materials have about as many runs as the hills of docs/architecture.md.
struct HeightMap {
  double elevation;
  unsigned octaves;
  std::int32_t ground(VoxelPos at) const {
    const double noise = fractal_noise(at.x / 40.0, 0.5, at.z / 40.0, 11, octaves);
    return static_cast<std::int32_t>(std::ceil(elevation * noise));
  }
};
constexpr HeightMap kGentle = {16, 3}, kRough = {20, 4};

Block hills_plain(std::int32_t y, std::int32_t ground) {
  return y < ground ? Block::stone : Block::air;
}

Block hills(std::int32_t y, std::int32_t ground) {
  if (y >= ground) return Block::air;
  if (y == ground - 1) return Block::grass;
  return y >= ground - 4 ? Block::dirt : Block::stone;
}

Block terrain(std::int32_t y, std::int32_t ground) {
  if (y >= ground) return y < 0 ? Block::water : Block::air;
  return y == ground - 1 && ground <= 1 ? Block::sand : hills(y, ground);
}

void overhangs_column(VoxelPos at, std::span<Material> out) {
  constexpr std::size_t kSoil = 3;
  std::array<bool, kSideMax + kSoil> solid{};
  for (std::size_t i = 0; i < out.size() + kSoil; ++i) {
    const std::int32_t y = at.y + static_cast<std::int32_t>(i);
    solid[i] = fractal_noise(at.x / 24.0, y / 24.0, at.z / 24.0, 31, 3) > y / 22.0;
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    Block block = Block::stone;
    if (!solid[i + 3] || !solid[i + 2]) block = Block::dirt;
    if (!solid[i + 1]) block = Block::grass;
    out[i] = id_of(solid[i] ? block : Block::air);
  }
}

Block caves(VoxelPos at) {
  if (std::abs(fractal_noise(at.x / 18.0, at.y / 14.0, at.z / 18.0, 51, 2)) < 0.12)
    return Block::air;
  return fractal_noise(at.x / 9.0, at.y / 9.0, at.z / 9.0, 71, 1) > 0.6 ? Block::ore : Block::stone;
}

Block noise(VoxelPos at) {
  return lattice_value(at.x, at.y, at.z, 5) < 0 ? Block::stone : Block::air;
}

Block noise_mixed(VoxelPos at) {
  constexpr std::array kMixed = {Block::stone, Block::dirt, Block::brick, Block::glass,
                                 Block::water};
  const double value = lattice_value(at.x, at.y, at.z, 6);
  return value < 0 ? Block::air : kMixed[static_cast<std::size_t>(value * kMixed.size())];
}

Block sparse(VoxelPos at) {
  return lattice_value(at.x, at.y, at.z, 7) < -0.9 ? Block::stone : Block::air;
}

Block checkerboard(VoxelPos at) {
  return (at.x + at.y + at.z) % 2 == 0 ? Block::stone : Block::air;
}

/// Returns a column from a formula of places.
template <class Formula>
auto by_voxel(Formula formula) {
  return [formula](VoxelPos at, std::span<Material> out) {
    for (Material& material : out) {
      material = id_of(formula(at));
      ++at.y;
    }
  };
}

/// Returns a column from a formula of heights above and below the ground.
template <class Formula>
auto by_ground(HeightMap map, Formula formula) {
  return [map, formula](VoxelPos at, std::span<Material> out) {
    const std::int32_t ground = map.ground(at);
    for (Material& material : out) material = id_of(formula(at.y++, ground));
  };
}

}  // namespace

const MaterialTable& seeded_materials() {
  static const MaterialTable table = [] {
    MaterialTable t;
    constexpr std::uint8_t kOpaque = 255, kClear = 150;
    for (const auto& [name, colour] : std::initializer_list<std::pair<const char*, MaterialColour>>{
             {"stone", {128, 128, 128, kOpaque}},
             {"dirt", {121, 85, 58, kOpaque}},
             {"grass", {95, 159, 53, kOpaque}},
             {"sand", {219, 207, 163, kOpaque}},
             {"water", {63, 118, 228, kClear}},
             {"glass", {200, 220, 230, kClear}},
             {"wood", {155, 118, 74, kOpaque}},
             {"brick", {150, 75, 60, kOpaque}},
             {"leaves", {58, 110, 38, kOpaque}},
             {"ore", {200, 160, 60, kOpaque}},
             {"tiles", {170, 170, 180, kOpaque}}}) {
      MaterialInfo info;
      info.name = name;
      info.colour = colour;
      info.visibility = colour[3] == kClear ? Visibility::transparent : Visibility::opaque;
      RUNSTONE_ASSERT(t.add(info).has_value());
    }
    return t;
  }();
  return table;
}

std::vector<VoxelWorld> seeded_worlds() {
  const auto visibility = std::make_shared<const VisibilityTable>(visibilities(seeded_materials()));
  std::vector<VoxelWorld> out;
  const auto add = [&](const char* name, auto column) {
    out.push_back({name, visibility, std::nullopt, std::move(column), nullptr});
  };
  add("hills", by_ground(kGentle, hills));
  add("hills_plain", by_ground(kGentle, hills_plain));
  add("terrain", by_ground(kRough, terrain));
  add("overhangs", overhangs_column);
  add("caves", by_voxel(caves));
  add("town", town_column);
  add("noise", by_voxel(noise));
  add("noise_mixed", by_voxel(noise_mixed));
  add("sparse", by_voxel(sparse));
  add("checkerboard", by_voxel(checkerboard));
  add("uniform", by_voxel([](VoxelPos) { return Block::stone; }));
  add("empty", by_voxel([](VoxelPos) { return Block::air; }));
  return out;
}

}  // namespace runstone::bench
