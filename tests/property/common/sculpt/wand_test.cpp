#include "common/sculpt/wand.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "common/core/hash.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kEdge = 8;
/// Chunks -2 .. 1 along each axis.
constexpr std::int32_t kLow = -2 * kEdge, kHigh = 2 * kEdge;

using VoxelSet = std::set<VoxelPos>;

/// A world of random chunks in random axis orders.
struct WandWorld {
  explicit WandWorld(SplitMix64& rng) {
    for (std::int32_t x = -2; x < 2; ++x) {
      for (std::int32_t y = -2; y < 2; ++y) {
        for (std::int32_t z = -2; z < 2; ++z) {
          chunks[{x, y, z}] = std::make_shared<const RunChunk>(
              random_chunk(rng, Extent::cube(kEdge), random_order(rng), 4, ChunkShape::boxes));
        }
      }
    }
  }
  Material at(VoxelPos voxel) const {
    return material_at(*chunks.at(chunk_of(voxel, kEdge)), local_of(voxel, kEdge));
  }
  static bool contains(VoxelPos v) {
    return VoxelBox{{kLow, kLow, kLow}, {kHigh, kHigh, kHigh}}.contains(v);
  }
  ChunkLookup lookup() const {
    return [this](ChunkCoord at) {
      const auto found = chunks.find(at);
      return found == chunks.end() ? nullptr : found->second;
    };
  }
  std::map<ChunkCoord, std::shared_ptr<const RunChunk>> chunks;
};

bool is_found(const WandSearch& search, Material material) {
  return search.material ? *search.material == material : material != kEmpty;
}

/// Floods voxel by voxel. Returns nullopt if it reaches the end of the world.
std::optional<VoxelSet> flooded(const WandWorld& world, const WandSearch& search, VoxelPos start) {
  VoxelSet out = {start};
  std::deque<VoxelPos> waiting = {start};
  while (!waiting.empty()) {
    const VoxelPos v = waiting.front();
    waiting.pop_front();
    for (const VoxelPos next :
         {VoxelPos{v.x - 1, v.y, v.z}, VoxelPos{v.x + 1, v.y, v.z}, VoxelPos{v.x, v.y - 1, v.z},
          VoxelPos{v.x, v.y + 1, v.z}, VoxelPos{v.x, v.y, v.z - 1}, VoxelPos{v.x, v.y, v.z + 1}}) {
      if (!WandWorld::contains(next)) return std::nullopt;
      if (is_found(search, world.at(next)) && out.insert(next).second) waiting.push_back(next);
    }
  }
  return out;
}

VoxelSet voxels_of(const VoxelRows& rows) {
  VoxelSet out;
  for (const auto& [z, y] : rows.places()) {
    for (const RowStretch& part : *rows.row(y, z)) {
      for (std::int32_t x = part.low; x < part.high; ++x) out.insert({x, y, z});
    }
  }
  return out;
}

VoxelPos random_voxel(SplitMix64& rng, std::int32_t low, std::int32_t high) {
  return {rng.between(low, high), rng.between(low, high), rng.between(low, high)};
}

}  // namespace

TEST_CASE("the wand finds what a flood voxel by voxel finds", "[sculpt][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  int found = 0;
  for (int round = 0; round < 300; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const WandWorld world(rng);
    const VoxelPos start = random_voxel(rng, -kEdge, kEdge - 1);
    WandSearch search{world.at(start), 1'000'000};
    if (round % 4 == 0) search.material.reset();
    const auto made = connected_voxels(search, start, kEdge, world.lookup());
    if (!is_found(search, world.at(start))) {
      REQUIRE_FALSE(made);
      CHECK(made.error() == FloodFault::blocked);
      continue;
    }
    const auto expected = flooded(world, search, start);
    if (!expected) {
      REQUIRE_FALSE(made);
      CHECK(made.error() == FloodFault::missing_chunk);
      continue;
    }
    ++found;
    REQUIRE(made);
    CHECK(voxels_of(*made) == *expected);
    CHECK(made->count() == expected->size());
    search.voxels_max = expected->size() - 1;
    const auto less = connected_voxels(search, start, kEdge, world.lookup());
    REQUIRE_FALSE(less);
    CHECK(less.error() == FloodFault::too_many_voxels);
  }
  CHECK(found > 20);
}

TEST_CASE("voxels of boxes by material, and their build, equal the world", "[sculpt][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (int round = 0; round < 60; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const WandWorld world(rng);
    const VoxelPos a = random_voxel(rng, kLow, kHigh - 1), b = random_voxel(rng, kLow, kHigh - 1);
    const VoxelBox box{{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
                       {std::max(a.x, b.x) + 1, std::max(a.y, b.y) + 1, std::max(a.z, b.z) + 1}};
    // Two of the boxes lie beside each other.
    std::vector<VoxelBox> boxes = {box};
    if (const std::int32_t cut = (box.min.y + box.max.y) / 2; round % 2 == 0 && cut > box.min.y) {
      boxes.front().max.y = cut;
      boxes.push_back({{box.min.x, cut, box.min.z}, box.max});
    }
    WandSearch search{static_cast<Material>(rng.between(1, 3)), 1'000'000};
    if (round % 3 == 0) search.material.reset();
    VoxelSet expected;
    for (VoxelPos v = box.min; v.z < box.max.z; ++v.z) {
      for (v.y = box.min.y; v.y < box.max.y; ++v.y) {
        for (v.x = box.min.x; v.x < box.max.x; ++v.x) {
          if (is_found(search, world.at(v))) expected.insert(v);
        }
      }
    }
    const auto made = voxels_of_boxes(search, boxes, kEdge, world.lookup());
    if (expected.empty()) {
      REQUIRE_FALSE(made);
      continue;
    }
    REQUIRE(made);
    CHECK(voxels_of(*made) == expected);
    const auto placed = build_of_voxels(*made, kEdge, world.lookup());
    REQUIRE(placed);
    CHECK(placed->build->touched() == expected.size());
    VoxelRows whole;
    for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
      for (std::int32_t y = box.min.y; y < box.max.y; ++y) whole.add(y, z, {box.min.x, box.max.x});
    }
    whole.join();
    const auto with_air = build_of_voxels(whole, kEdge, world.lookup(), true);
    REQUIRE(with_air);
    CHECK(with_air->build->touched() == with_air->build->volume());
    for (const VoxelPos v : expected) {
      REQUIRE(with_air->build->at({v.x - box.min.x, v.y - box.min.y, v.z - box.min.z}) ==
              std::optional(world.at(v)));
      const VoxelPos cell{v.x - placed->at.x, v.y - placed->at.y, v.z - placed->at.z};
      REQUIRE(placed->build->at(cell) == std::optional(world.at(v)));
    }
  }
}

TEST_CASE("sets of voxels are united, cut, moved and grown as each voxel says",
          "[sculpt][property]") {
  SplitMix64 rng{Catch::rngSeed() + 5};
  const auto random_rows = [&] {
    VoxelRows out;
    for (int i = rng.between(1, 60); i > 0; --i) {
      const VoxelPos low = random_voxel(rng, -5, 5);
      out.add(low.y, low.z, {low.x, low.x + rng.between(1, 6)});
    }
    out.join();
    return out;
  };
  for (int round = 0; round < 30; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const VoxelRows a = random_rows(), b = random_rows();
    const VoxelSet in_a = voxels_of(a), in_b = voxels_of(b);
    const VoxelPos by = random_voxel(rng, -3, 3);
    const auto direction = static_cast<Direction>(rng.below(kDirectionCount));
    const std::int32_t steps = rng.between(0, 5);
    VoxelSet any = in_a, first, both, there, longer, shorter;
    any.insert(in_b.begin(), in_b.end());
    const auto step_from = [&](VoxelPos v, std::int32_t i) {
      const std::int32_t way = is_positive(direction) ? i : -i;
      const Axis axis = axis_of(direction);
      return VoxelPos{v.x + (axis == Axis::x ? way : 0), v.y + (axis == Axis::y ? way : 0),
                      v.z + (axis == Axis::z ? way : 0)};
    };
    for (const VoxelPos v : in_a) {
      (in_b.contains(v) ? both : first).insert(v);
      there.insert({v.x + by.x, v.y + by.y, v.z + by.z});
      bool all = true;
      for (std::int32_t i = 0; i <= steps; ++i) {
        longer.insert(step_from(v, i));
        all = all && in_a.contains(step_from(v, i));
      }
      if (all) shorter.insert(v);
      CHECK(a.contains(v));
    }
    for (const VoxelPos v : in_b) CHECK(a.contains(v) == in_a.contains(v));
    CHECK(voxels_of(united(a, b)) == any);
    CHECK(voxels_of(without(a, b)) == first);
    CHECK(voxels_of(common(a, b)) == both);
    CHECK(voxels_of(moved(a, by)) == there);
    CHECK(voxels_of(grown_to(a, direction, steps)) == longer);
    CHECK(voxels_of(shrunk_from(a, direction, steps)) == shorter);
    CHECK(a.count() == in_a.size());
  }
}

TEST_CASE("a set grows and shrinks as each voxel says", "[sculpt][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (int round = 0; round < 8; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    VoxelRows rows;
    for (int i = rng.between(1, 30); i > 0; --i) {
      const VoxelPos low = random_voxel(rng, -9, 6);
      for (std::int32_t z = low.z; z < low.z + 6; ++z) {
        for (std::int32_t y = low.y; y < low.y + 6; ++y)
          rows.add(y, z, {low.x, low.x + rng.between(4, 7)});
      }
    }
    rows.join();
    // A dense grid, because each voxel is read many times.
    constexpr std::int32_t kSide = 48;
    std::vector<bool> set(std::size_t{kSide} * kSide * kSide);
    const auto slot = [](VoxelPos v) {
      return static_cast<std::size_t>(v.x + 24 + kSide * (v.y + 24 + kSide * (v.z + 24)));
    };
    for (const VoxelPos v : voxels_of(rows)) set[slot(v)] = true;
    const std::int32_t steps = rng.between(1, 3);
    VoxelSet more, less;
    for (VoxelPos v{-16, -16, -16}; v.z < 17; ++v.z) {
      for (v.y = -16; v.y < 17; ++v.y) {
        for (v.x = -16; v.x < 17; ++v.x) {
          bool any = false, all = true;
          for (VoxelPos n{0, 0, v.z - steps}; n.z <= v.z + steps; ++n.z) {
            for (n.y = v.y - steps; n.y <= v.y + steps; ++n.y) {
              for (n.x = v.x - steps; n.x <= v.x + steps; ++n.x) {
                const bool is_in = set[slot(n)];
                any |= is_in;
                all &= is_in;
              }
            }
          }
          if (any) more.insert(v);
          if (all) less.insert(v);
        }
      }
    }
    CHECK(voxels_of(grown(rows, steps)) == more);
    CHECK(voxels_of(shrunk(rows, steps)) == less);
  }
}

}  // namespace runstone::test
