#include "bench/worlds/town.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "bench/worlds/seeded_worlds.hpp"
#include "common/core/hash.hpp"

namespace runstone::bench {
namespace {

constexpr std::int32_t kLot = 16;      // voxels a side, street included
constexpr std::int32_t kStreet = 3;    // width
constexpr std::int32_t kStorey = 4;    // height
constexpr std::int32_t kHouseLow = 4;  // first and last voxel of a house in its lot
constexpr std::int32_t kHouseHigh = 14;

/// The building or garden of a lot.
struct Lot {
  explicit Lot(std::int32_t x, std::int32_t z) {
    SplitMix64 rng(mix64(static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32 |
                         static_cast<std::uint32_t>(z)));
    garden = rng.below(5) == 0;
    storeys = rng.between(1, 5);
    walls = rng.below(2) == 0 ? Block::brick : Block::wood;
    stepped_roof = rng.below(2) == 0;
    trunk = rng.between(4, 7);
  }
  bool garden, stepped_roof;
  std::int32_t storeys, trunk;  // trunk: height of the tree below its crown
  Block walls;
};

Block ground(std::int32_t y) {
  if (y < -4) return Block::stone;
  return y < -1 ? Block::dirt : Block::grass;
}

Block tree(const Lot& lot, std::int32_t x, std::int32_t y, std::int32_t z) {
  const std::int32_t dx = x - 9, dz = z - 9, dy = y - lot.trunk - 1;
  if (dx == 0 && dz == 0 && y <= lot.trunk) return Block::wood;
  return dx * dx + dy * dy + dz * dz <= 10 ? Block::leaves : Block::air;
}

Block house(const Lot& lot, std::int32_t x, std::int32_t y, std::int32_t z) {
  const std::int32_t inside =
      std::min({x - kHouseLow, kHouseHigh - x, z - kHouseLow, kHouseHigh - z});
  const std::int32_t top = lot.storeys * kStorey;
  if (inside < 0) return Block::air;
  if (y == top) return Block::tiles;
  if (y > top) return lot.stepped_roof && y - top <= inside ? Block::tiles : Block::air;
  const std::int32_t in_storey = y % kStorey;
  if (inside > 0) return in_storey == 0 ? Block::wood : Block::air;
  if (x == 9 && z == kHouseLow && y < 3) return Block::air;  // the door
  const std::int32_t along = x == kHouseLow || x == kHouseHigh ? z : x;
  const bool pane = in_storey >= 1 && in_storey <= 2 && along % 3 != 0 && along > kHouseLow + 1 &&
                    along < kHouseHigh - 1;
  return pane ? Block::glass : lot.walls;
}

}  // namespace

void town_column(VoxelPos at, std::span<Material> out) {
  const std::int32_t lot_x = floor_div(at.x, kLot), lot_z = floor_div(at.z, kLot);
  const std::int32_t x = at.x - lot_x * kLot, z = at.z - lot_z * kLot;
  const Lot lot(lot_x, lot_z);
  const bool street = x < kStreet || z < kStreet;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::int32_t y = at.y + static_cast<std::int32_t>(i);
    Block block = Block::air;
    if (y < 0) {
      block = street && y == -1 ? Block::stone : ground(y);
    } else if (!street) {
      block = lot.garden ? tree(lot, x, y, z) : house(lot, x, y, z);
    }
    out[i] = id_of(block);
  }
}

}  // namespace runstone::bench
