// Hills: ground for tests of brushes and scattering.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/hash.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone::test {

inline constexpr std::int32_t kHillEdge = 32, kHillWater = 4;

/// Hills with soil, water in the valleys and plants. Chunks are made once. Thread: one at a time.
class Hills {
 public:
  static constexpr std::int32_t kLow = -64, kHigh = 64;

  /// Returns the hills that all tests share.
  static const Hills& shared() {
    static const Hills kHills;
    return kHills;
  }

  Hills() {
    grass = *table.find("grass");
    dirt = *table.find("dirt");
    stone = *table.find("stone");
    water = *table.find("water");
    MaterialInfo info;
    info.name = "flower";
    info.visibility = Visibility::transparent;
    info.body = MaterialBody::passable;
    flower = *table.add(info);
  }
  std::int32_t height(std::int32_t x, std::int32_t z) const {
    return 6 + static_cast<std::int32_t>(
                   std::lround(7 * std::sin(x * 0.21) + 5 * std::cos(z * 0.17 + x * 0.05)));
  }
  Material at(VoxelPos p) const {
    const std::int32_t top = height(p.x, p.z);
    if (p.y > top) {
      if (p.y <= kHillWater) return water;
      const bool has_flower = mix64(static_cast<std::uint64_t>(p.x * 977 + p.z)) % 7 == 0;
      return p.y == top + 1 && has_flower ? flower : kEmpty;
    }
    if (p.y == top) return grass;
    return p.y > top - 4 ? dirt : stone;
  }
  std::shared_ptr<const RunChunk> operator()(ChunkCoord coord) const {
    const VoxelPos o = origin_of(coord, kHillEdge);
    if (o.y < kLow || o.y >= kHigh) return nullptr;
    std::shared_ptr<const RunChunk>& chunk = chunks_[coord];
    if (chunk) return chunk;
    RunBuilder out(Extent::cube(kHillEdge), AxisOrder::xyz);
    for (std::int32_t z = 0; z < kHillEdge; ++z) {
      for (std::int32_t y = 0; y < kHillEdge; ++y) {
        for (std::int32_t x = 0; x < kHillEdge; ++x) out.append(1, at({o.x + x, o.y + y, o.z + z}));
      }
    }
    return chunk = std::make_shared<const RunChunk>(in_cheapest_order(out.finish()));
  }
  /// Returns the column when its surface lies at `to`.
  std::vector<Material> moved_column(std::int32_t x, std::int32_t z, std::int32_t to) const {
    const std::int32_t from = height(x, z);
    std::vector<Material> old, ground;
    for (std::int32_t y = kLow; y < kHigh; ++y) old.push_back(at({x, y, z}));
    const auto index = [](std::int32_t y) { return static_cast<std::size_t>(y - kLow); };
    if (to == from) return old;
    ground.assign(old.begin(), old.begin() + from - kLow - 3);
    ground.resize(ground.size() + static_cast<std::size_t>(to - from), stone);
    ground.insert(ground.end(), old.begin() + from - kLow - 3, old.begin() + from - kLow + 1);
    const Material above = old[index(from + 1)];
    std::vector<Material> out = old;
    for (std::int32_t y = std::min(from, to) + 1; y <= from; ++y)
      out[index(y)] = above == water ? water : kEmpty;
    std::copy(ground.begin(), ground.end(), out.begin());
    if (above == flower) {
      if (to < from) out[index(from + 1)] = kEmpty;
      if (to < from || out[index(to + 1)] == kEmpty) out[index(to + 1)] = flower;
    }
    return out;
  }

  MaterialTable table = default_material_table();
  Material grass = 0, dirt = 0, stone = 0, water = 0, flower = 0;

 private:
  mutable std::map<ChunkCoord, std::shared_ptr<const RunChunk>> chunks_;
};

}  // namespace runstone::test
