#include "tests/support/runs/random_chunk.hpp"

#include <algorithm>
#include <vector>

#include "common/core/assert.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone::test {
namespace {

// The ids of a chunk: 0 and `count - 1` others, small or spread over all of u16.
class Palette {
 public:
  Palette(SplitMix64& rng, unsigned count)
      : count_(count), spread_(count <= 256 && rng.below(4) == 0) {}
  Material pick(SplitMix64& rng) const { return id(rng.below(count_)); }
  Material id(std::uint32_t i) const {
    i %= count_;
    return static_cast<Material>(spread_ && i != 0 ? 65536 - i : i);
  }

 private:
  std::uint32_t count_;
  bool spread_;
};

struct Blob {
  int min[3], max[3], radius;
  Material material;
};

// Calls material(x, y, z) for every voxel in flattened order.
template <class F>
RunChunk stream(Extent extent, AxisOrder order, F&& material) {
  RunBuilder builder(extent, order);
  const OrderedExtent e = ordered(extent, order);
  for (std::uint32_t s = 0; s < e.s; ++s) {
    for (std::uint32_t m = 0; m < e.m; ++m) {
      for (std::uint32_t f = 0; f < e.f; ++f) {
        const LocalPos p = from_ordered({f, m, s}, order);
        builder.append(1, material(int{p.x}, int{p.y}, int{p.z}));
      }
    }
  }
  return builder.finish();
}

std::vector<Blob> random_blobs(SplitMix64& rng, Extent extent, const Palette& palette) {
  std::vector<Blob> blobs(1 + rng.below(8));
  const int sides[3] = {extent.x, extent.y, extent.z};
  for (Blob& blob : blobs) {
    for (int axis = 0; axis < 3; ++axis) {
      blob.min[axis] = rng.between(0, sides[axis] - 1);
      blob.max[axis] = rng.between(blob.min[axis] + 1, sides[axis]);
    }
    blob.radius = rng.between(1, 12);
    blob.material = palette.pick(rng);
  }
  return blobs;
}

bool in_ball(const Blob& b, int x, int y, int z) {
  const int dx = x - b.min[0];
  const int dy = y - b.min[1];
  const int dz = z - b.min[2];
  return dx * dx + dy * dy + dz * dz <= b.radius * b.radius;
}

bool in_box(const Blob& b, int x, int y, int z) {
  return x >= b.min[0] && x < b.max[0] && y >= b.min[1] && y < b.max[1] && z >= b.min[2] &&
         z < b.max[2];
}

}  // namespace

Extent random_extent(SplitMix64& rng, unsigned side_max) {
  RUNSTONE_ASSERT(side_max >= kSideMin && side_max <= kSideMax);
  const auto side = [&] {
    // The smaller of two draws is taken, so that small sides are frequent and large ones occur.
    const std::uint32_t a = rng.below(side_max - kSideMin + 1);
    const std::uint32_t b = rng.below(side_max - kSideMin + 1);
    return static_cast<std::uint8_t>(kSideMin + (a < b ? a : b));
  };
  Extent extent;
  extent.x = side();
  extent.y = side();
  extent.z = side();
  return extent;
}

AxisOrder random_order(SplitMix64& rng) { return kAxisOrders[rng.below(kAxisOrderCount)]; }

RunChunk random_chunk(SplitMix64& rng, Extent extent, AxisOrder order, unsigned materials,
                      ChunkShape shape) {
  RUNSTONE_ASSERT(materials >= 1 && materials <= 65536);
  const Palette palette(rng, materials);
  switch (shape) {
    case ChunkShape::uniform:
      return uniform_chunk(extent, palette.pick(rng), order);
    case ChunkShape::layered: {
      std::vector<Material> layers(extent.y);
      for (std::size_t y = 0; y < layers.size(); ++y) {
        layers[y] = y > 0 && rng.below(3) != 0 ? layers[y - 1] : palette.pick(rng);
      }
      return stream(extent, order,
                    [&](int, int y, int) { return layers[static_cast<std::size_t>(y)]; });
    }
    case ChunkShape::
        // A height map: ground of two materials, water up to a level, empty above.
        columns: {
      std::vector<int> heights(static_cast<std::size_t>(extent.x) * extent.z);
      int height = rng.between(0, extent.y);
      for (int& h : heights) {
        height = std::clamp(height + rng.between(-1, 1), 0, int{extent.y});
        h = height;
      }
      const int water = rng.between(0, extent.y);
      const std::uint32_t ground = rng.below(materials);
      return stream(extent, order, [&](int x, int y, int z) {
        const int h = heights[static_cast<std::size_t>(x + extent.x * z)];
        if (y < h) return palette.id(y + 3 < h ? ground : ground + 1);
        return palette.id(y < water ? ground + 2 : 0);
      });
    }
    case ChunkShape::boxes:
    case ChunkShape::spheres: {
      const std::vector<Blob> blobs = random_blobs(rng, extent, palette);
      const Material ground = palette.pick(rng);
      const bool round = shape == ChunkShape::spheres;
      return stream(extent, order, [&](int x, int y, int z) {
        for (const Blob& b : blobs) {
          if (round ? in_ball(b, x, y, z) : in_box(b, x, y, z)) return b.material;
        }
        return ground;
      });
    }
    // Mostly one material with ores in it.
    case ChunkShape::speckled: {
      const Material ground = palette.pick(rng);
      const std::uint32_t rarity = 2 + rng.below(200);
      return stream(extent, order, [&](int, int, int) {
        return rng.below(rarity) == 0 ? palette.pick(rng) : ground;
      });
    }
    case ChunkShape::noise:
      return stream(extent, order, [&](int, int, int) { return palette.pick(rng); });
    case ChunkShape::checkerboard: {
      const std::uint32_t other = 1 + rng.below(materials);
      return stream(extent, order, [&](int x, int y, int z) {
        return palette.id(((x + y + z) & 1) != 0 ? other : 0);
      });
    }
  }
  assertion_failed("a known shape", __FILE__, __LINE__);
}

RunChunk random_chunk(SplitMix64& rng, Extent extent, AxisOrder order, unsigned materials) {
  return random_chunk(rng, extent, order, materials,
                      static_cast<ChunkShape>(rng.below(kShapeCount)));
}

RunChunk random_chunk(SplitMix64& rng, unsigned side_max, unsigned materials) {
  // This is a separate statement, because the order in which arguments are evaluated is
  // unspecified.
  const Extent extent = random_extent(rng, side_max);
  const AxisOrder order = random_order(rng);
  return random_chunk(rng, extent, order, materials);
}

RunChunk random_chunk(SplitMix64& rng) {
  const Extent extent = rng.below(32) == 0 ? random_extent(rng, kSideMax) : random_extent(rng);
  const AxisOrder order = random_order(rng);
  static constexpr unsigned kMaterials[] = {2, 2, 3, 5, 16, 64, 300, 65536};
  return random_chunk(rng, extent, order, kMaterials[rng.below(8)]);
}

}  // namespace runstone::test
