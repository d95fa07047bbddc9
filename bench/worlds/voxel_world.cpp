#include "bench/worlds/voxel_world.hpp"

#include <array>
#include <utility>
#include <vector>

#include "common/runs/reorder.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone::bench {
namespace {

VoxelBox cube_at(VoxelPos origin, std::int32_t side) {
  return {origin, {origin.x + side, origin.y + side, origin.z + side}};
}

bool knows(const VoxelWorld& world, const VoxelBox& box) {
  return !world.bounds || !intersect(*world.bounds, box).empty();
}

/// Returns the lowest coordinates of the volumes along one axis.
std::vector<std::int32_t> places(std::int32_t low, std::int32_t high, std::int32_t side) {
  std::vector<std::int32_t> out;
  for (std::int32_t at = low; at + side <= high; at += side) out.push_back(at);
  if (!out.empty() && out.back() + side < high) out.push_back(high - side);
  return out;
}

}  // namespace

RunChunk chunk_of_world(const VoxelWorld& world, VoxelPos origin, unsigned edge) {
  const auto side = static_cast<std::int32_t>(edge);
  RunBuilder builder(Extent::cube(edge), AxisOrder::yxz);
  const VoxelBox all = cube_at(origin, side);
  const VoxelBox known = world.bounds ? intersect(*world.bounds, all) : all;
  std::array<Material, kSideMax> column{};
  for (std::int32_t z = 0; z < side; ++z) {
    for (std::int32_t x = 0; x < side; ++x) {
      column.fill(kEmpty);
      const VoxelPos low = {origin.x + x, known.min.y, origin.z + z};
      if (known.contains(low)) {
        const auto height = static_cast<std::size_t>(known.max.y - known.min.y);
        world.column(low,
                     std::span(column).subspan(static_cast<std::size_t>(low.y - origin.y), height));
      }
      for (unsigned y = 0; y < edge; ++y) builder.append(1, column[y]);
    }
  }
  return in_cheapest_order(builder.finish());
}

Volume cut_volume(const VoxelWorld& world, VoxelPos origin, unsigned edge) {
  const auto side = static_cast<std::int32_t>(edge);
  Volume out{origin, edge, {chunk_of_world(world, origin, edge), {}}};
  for (unsigned d = 0; d < kDirectionCount; ++d) {
    const ChunkCoord step = neighbour({}, static_cast<Direction>(d));
    const VoxelPos beside = {origin.x + step.x * side, origin.y + step.y * side,
                             origin.z + step.z * side};
    if (knows(world, cube_at(beside, side))) {
      out.scene.neighbours[d] = chunk_of_world(world, beside, edge);
    }
  }
  return out;
}

std::vector<Volume> volumes_in(const VoxelWorld& world, const VoxelBox& box, unsigned edge) {
  const auto side = static_cast<std::int32_t>(edge);
  std::vector<Volume> out;
  for (const std::int32_t z : places(box.min.z, box.max.z, side)) {
    for (const std::int32_t y : places(box.min.y, box.max.y, side)) {
      for (const std::int32_t x : places(box.min.x, box.max.x, side)) {
        out.push_back(cut_volume(world, {x, y, z}, edge));
      }
    }
  }
  return out;
}

std::vector<Volume> volumes_of(const VoxelWorld& world, unsigned edge) {
  std::vector<Volume> out;
  if (!world.bounds) {
    out.push_back(cut_volume(world, {0, -static_cast<std::int32_t>(edge) / 2, 0}, edge));
    return out;
  }
  out = volumes_in(world, *world.bounds, edge);
  std::erase_if(out, [](const Volume& volume) { return volume.scene.chunk.is_uniform(); });
  return out;
}

}  // namespace runstone::bench
