// Positions, boxes and directions. y is up and the system is right-handed. A voxel covers [x, x+1)
// x [y, y+1) x [z, z+1). The three kinds of position are three types, so that they cannot be mixed.
// Boxes are half-open.
#pragma once
#include <algorithm>
#include <compare>
#include <cstdint>

namespace runstone {

enum class Axis : std::uint8_t { x = 0, y = 1, z = 2 };

/// World coordinates lie in [-kWorldLimit, kWorldLimit), so the sum or difference of two of them
/// fits i32.
inline constexpr std::int32_t kWorldLimit = 1 << 29;

struct VoxelPos {
  std::int32_t x = 0, y = 0, z = 0;
  friend auto operator<=>(const VoxelPos&, const VoxelPos&) = default;
};

/// Position inside one chunk, 0 .. side - 1 along each axis.
struct LocalPos {
  std::uint8_t x = 0, y = 0, z = 0;
  friend auto operator<=>(const LocalPos&, const LocalPos&) = default;
};

/// Position in the grid of chunks.
struct ChunkCoord {
  std::int32_t x = 0, y = 0, z = 0;
  friend auto operator<=>(const ChunkCoord&, const ChunkCoord&) = default;
};

/// Names a chunk in memory, log, wire and store. lod 0 is full detail.
struct ChunkKey {
  std::uint8_t lod = 0;
  ChunkCoord at;
  friend auto operator<=>(const ChunkKey&, const ChunkKey&) = default;
};

/// Half-open box of voxels. It is empty if any side is empty.
struct VoxelBox {
  VoxelPos min, max;
  friend auto operator<=>(const VoxelBox&, const VoxelBox&) = default;
  constexpr bool empty() const { return max.x <= min.x || max.y <= min.y || max.z <= min.z; }
  constexpr bool contains(VoxelPos p) const {
    return p.x >= min.x && p.x < max.x && p.y >= min.y && p.y < max.y && p.z >= min.z &&
           p.z < max.z;
  }
};

constexpr std::int32_t floor_div(std::int32_t a, std::int32_t b) {
  return a / b - static_cast<std::int32_t>(a % b != 0 && (a < 0) != (b < 0));
}

constexpr VoxelBox intersect(const VoxelBox& a, const VoxelBox& b) {
  return {{std::max(a.min.x, b.min.x), std::max(a.min.y, b.min.y), std::max(a.min.z, b.min.z)},
          {std::min(a.max.x, b.max.x), std::min(a.max.y, b.max.y), std::min(a.max.z, b.max.z)}};
}

/// Returns the smallest box that holds both. An empty box adds nothing.
constexpr VoxelBox bounding_box(const VoxelBox& a, const VoxelBox& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {{std::min(a.min.x, b.min.x), std::min(a.min.y, b.min.y), std::min(a.min.z, b.min.z)},
          {std::max(a.max.x, b.max.x), std::max(a.max.y, b.max.y), std::max(a.max.z, b.max.z)}};
}

/// Returns the chunk that holds a voxel. World chunks are cubes of `edge` voxels a side.
constexpr ChunkCoord chunk_of(VoxelPos p, std::int32_t edge) {
  return {floor_div(p.x, edge), floor_div(p.y, edge), floor_div(p.z, edge)};
}

/// Returns the first voxel of a chunk.
constexpr VoxelPos origin_of(ChunkCoord c, std::int32_t edge) {
  return {c.x * edge, c.y * edge, c.z * edge};
}

constexpr VoxelBox box_of(ChunkCoord c, std::int32_t edge) {
  const VoxelPos o = origin_of(c, edge);
  return {o, {o.x + edge, o.y + edge, o.z + edge}};
}

constexpr LocalPos local_of(VoxelPos p, std::int32_t edge) {
  const VoxelPos o = origin_of(chunk_of(p, edge), edge);
  return {static_cast<std::uint8_t>(p.x - o.x), static_cast<std::uint8_t>(p.y - o.y),
          static_cast<std::uint8_t>(p.z - o.z)};
}

/// The six directions that a face can have. The values are frozen: quads and the mesh tables hold
/// them.
enum class Direction : std::uint8_t {
  neg_x = 0,
  pos_x = 1,
  neg_y = 2,
  pos_y = 3,
  neg_z = 4,
  pos_z = 5
};
inline constexpr int kDirectionCount = 6;
constexpr Axis axis_of(Direction d) { return static_cast<Axis>(static_cast<std::uint8_t>(d) >> 1); }
constexpr bool is_positive(Direction d) { return (static_cast<std::uint8_t>(d) & 1) != 0; }
constexpr Direction opposite(Direction d) {
  return static_cast<Direction>(static_cast<std::uint8_t>(d) ^ 1);
}
constexpr ChunkCoord neighbour(ChunkCoord c, Direction d) {
  const std::int32_t step = is_positive(d) ? 1 : -1;
  switch (axis_of(d)) {
    case Axis::x:
      c.x += step;
      break;
    case Axis::y:
      c.y += step;
      break;
    case Axis::z:
      c.z += step;
      break;
  }
  return c;
}

}  // namespace runstone
