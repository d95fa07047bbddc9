#include "bench/frames/frames_world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "bench/worlds/luanti_world.hpp"
#include "common/core/assert.hpp"
#include "common/generate/scenarios/scenario_model.hpp"
#include "tests/support/scenarios/scenario_scene.hpp"

namespace runstone::bench {
namespace {

constexpr unsigned kFramesEdge = 32;
constexpr auto kSide = static_cast<std::int32_t>(kFramesEdge);
constexpr std::array<int, 3> kLuantiSize = {5, 3, 5};
constexpr std::string_view kScenario = "scenario_";

FramesWorld scenario_block(const std::string& name, unsigned number) {
  const auto world = test::scenario_generator(number, kFramesEdge);
  FramesWorld out{name,
                  kFramesEdge,
                  {3, 3, 3},
                  std::make_shared<const VisibilityTable>(test::scenario_visibility()),
                  {}};
  for (int z = 0; z < 3; ++z) {
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 3; ++x) {
        const ChunkCoord at = {x - 1, y - 1, z - 1};
        out.chunks.push_back({{x, y, z},
                              {origin_of(at, kSide), kFramesEdge,
                               test::scenario_scene(*world, at, kFramesEdge, false)}});
      }
    }
  }
  return out;
}

/// Returns the highest drawn voxel of a column inside the bounds, or the bounds' lowest if none is
/// drawn.
std::int32_t ground_of(const VoxelWorld& world, std::int32_t x, std::int32_t z) {
  std::vector<Material> column(1);
  for (std::int32_t y = world.bounds->max.y - 1; y > world.bounds->min.y; --y) {
    world.column({x, y, z}, column);
    if ((*world.visibility)[column[0]] != Visibility::empty) return y;
  }
  return world.bounds->min.y;
}

/// Returns where a block of `size` voxels begins along an axis, so that `middle` is in its middle
/// and the block stays within the bounds, if they are wide enough.
std::int32_t begin_around(std::int32_t middle, std::int32_t size, std::int32_t low,
                          std::int32_t high) {
  return std::clamp(middle - size / 2, low, std::max(low, high - size));
}

FramesWorld luanti_block(const VoxelWorld& world) {
  const VoxelBox& b = *world.bounds;
  const auto fit = [](int wanted, std::int32_t low, std::int32_t high) {
    return std::clamp((high - low) / kSide, 1, wanted);
  };
  const std::array<int, 3> size = {fit(kLuantiSize[0], b.min.x, b.max.x),
                                   fit(kLuantiSize[1], b.min.y, b.max.y),
                                   fit(kLuantiSize[2], b.min.z, b.max.z)};
  const std::int32_t x = b.min.x + (b.max.x - b.min.x) / 2, z = b.min.z + (b.max.z - b.min.z) / 2;
  const VoxelPos origin = {begin_around(x, size[0] * kSide, b.min.x, b.max.x),
                           begin_around(ground_of(world, x, z), size[1] * kSide, b.min.y, b.max.y),
                           begin_around(z, size[2] * kSide, b.min.z, b.max.z)};
  return block_of(world, origin, size, kFramesEdge);
}

}  // namespace

std::vector<std::string> frames_world_names() {
  std::vector<std::string> out;
  for (unsigned number = 1; number <= kScenarioCount; ++number) {
    out.push_back(fmt::format("{}{}", kScenario, number));
  }
  out.emplace_back("luanti");
  return out;
}

FramesWorld block_of(const VoxelWorld& world, VoxelPos origin, std::array<int, 3> size,
                     unsigned edge) {
  const auto side = static_cast<std::int32_t>(edge);
  FramesWorld out{world.name, edge, size, world.visibility, {}};
  out.materials = world.materials;
  for (int z = 0; z < size[2]; ++z) {
    for (int y = 0; y < size[1]; ++y) {
      for (int x = 0; x < size[0]; ++x) {
        const VoxelPos at = {origin.x + x * side, origin.y + y * side, origin.z + z * side};
        out.chunks.push_back({{x, y, z}, {at, edge, {chunk_of_world(world, at, edge), {}}}});
      }
    }
  }
  const auto chunk_at = [&](ChunkCoord c) -> const RunChunk* {
    if (std::min({c.x, c.y, c.z}) < 0 || c.x >= size[0] || c.y >= size[1] || c.z >= size[2])
      return nullptr;
    const auto index = static_cast<std::size_t>((c.z * size[1] + c.y) * size[0] + c.x);
    return &out.chunks[index].volume.scene.chunk;
  };
  for (FramesChunk& chunk : out.chunks) {
    for (unsigned d = 0; d < kDirectionCount; ++d) {
      const RunChunk* const beside = chunk_at(neighbour(chunk.at, static_cast<Direction>(d)));
      if (beside != nullptr) chunk.volume.scene.neighbours[d] = *beside;
    }
  }
  return out;
}

Result<FramesWorld, std::string> frames_world(const std::string& name, const std::string& luanti) {
  if (name.starts_with(kScenario)) {
    return scenario_block(name, static_cast<unsigned>(std::stoul(name.substr(kScenario.size()))));
  }
  RUNSTONE_ASSERT(name == "luanti");
  const auto world = luanti_world(luanti);
  if (!world) return failure(world.error());
  return luanti_block(*world);
}

}  // namespace runstone::bench
