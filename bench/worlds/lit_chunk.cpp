#include "bench/worlds/lit_chunk.hpp"

#include <algorithm>
#include <functional>

#include "bench/wire/luanti_form.hpp"
#include "bench/worlds/luanti_world.hpp"
#include "bench/worlds/measured_worlds.hpp"
#include "bench/worlds/seeded_worlds.hpp"
#include "common/formats/luanti_block.hpp"
#include "common/generate/generator.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/dense.hpp"
#include "common/runs/reorder.hpp"
#include "server/import/luanti_map.hpp"

namespace runstone::bench {
namespace {

constexpr auto kSide = static_cast<std::int32_t>(kByteEdge);
constexpr std::uint8_t kSun = 15;
// The height above a chunk up to which a voxel may shade it, because columns end there.
constexpr std::int32_t kSkyAbove = static_cast<std::int32_t>(kSideMax) - kSide;
constexpr VoxelBox kTerrainBox = {{-160, -64, -160}, {160, 96, 160}};
constexpr VoxelBox kSeededBox = {{0, -64, 0}, {128, 64, 128}};

/// Returns the y of the lowest voxel of a column that is open to the sky.
using OpenFrom = std::function<std::int32_t(std::int32_t x, std::int32_t z)>;

std::size_t voxel_index(std::int32_t x, std::int32_t y, std::int32_t z) {
  return static_cast<std::size_t>(x + kSide * (y + kSide * z));
}

LitChunk unlit(RunChunk runs) {
  LitChunk out{in_cheapest_order(std::move(runs)), {}, {}};
  out.voxels = to_dense(reorder(out.runs, AxisOrder::xyz));
  out.light.resize(out.voxels.size());
  return out;
}

LitChunk sunlit(RunChunk runs, VoxelPos origin, const OpenFrom& open_from) {
  LitChunk out = unlit(std::move(runs));
  for (std::int32_t z = 0; z < kSide; ++z) {
    for (std::int32_t x = 0; x < kSide; ++x) {
      const std::int32_t open = open_from(origin.x + x, origin.z + z);
      for (std::int32_t y = std::clamp(open - origin.y, 0, kSide); y < kSide; ++y) {
        out.light[voxel_index(x, y, z)] = kSun;
      }
    }
  }
  return out;
}

template <class Make>
std::vector<LitChunk> each_chunk(const VoxelBox& box, Make&& make) {
  std::vector<LitChunk> out;
  for (std::int32_t z = box.min.z; z + kSide <= box.max.z; z += kSide) {
    for (std::int32_t y = box.min.y; y + kSide <= box.max.y; y += kSide) {
      for (std::int32_t x = box.min.x; x + kSide <= box.max.x; x += kSide)
        out.push_back(make({x, y, z}));
    }
  }
  return out;
}

Result<std::vector<LitChunk>, std::string> noise_terrain() {
  const auto made = make_generator({"terrain", 1, 7, ""}, default_material_table());
  if (!made) return failure(made.error().what);
  const Generator& generator = **made;
  return each_chunk(kTerrainBox, [&](VoxelPos origin) {
    return sunlit(generator.generate(origin, Extent::cube(kByteEdge)), origin,
                  [&](std::int32_t x, std::int32_t z) { return generator.surface_y(x, z); });
  });
}

std::vector<LitChunk> seeded(const VoxelWorld& world) {
  return each_chunk(kSeededBox, [&](VoxelPos origin) {
    std::vector<Material> column(static_cast<std::size_t>(kSide + kSkyAbove));
    return sunlit(
        chunk_of_world(world, origin, kByteEdge), origin, [&](std::int32_t x, std::int32_t z) {
          world.column({x, origin.y, z}, column);
          const auto highest =
              std::find_if(column.rbegin(), column.rend(), [](Material m) { return m != kEmpty; });
          return origin.y + static_cast<std::int32_t>(column.rend() - highest);
        });
  });
}

/// A scenario's model has only sky around it.
std::vector<LitChunk> scenarios(const MeasuredWorlds& worlds) {
  std::vector<LitChunk> out;
  for (const Volume& volume : worlds.at_edge(0, kByteEdge).volumes) {
    const RunChunk& chunk = volume.scene.chunk;
    out.push_back(sunlit(chunk, {}, [&](std::int32_t x, std::int32_t z) {
      std::int32_t y = kSide;
      while (y > 0 &&
             material_at(chunk, {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y - 1),
                                 static_cast<std::uint8_t>(z)}) == kEmpty) {
        --y;
      }
      return y;
    }));
  }
  return out;
}

/// The place of a block of 16^3 in the chunks that each_chunk() makes of a box.
struct BlockPlace {
  std::size_t chunk = 0;
  std::int32_t x = 0, y = 0, z = 0;  // of its lowest voxel in the chunk
};

std::optional<BlockPlace> place_of(const ChunkCoord& block, const VoxelBox& box) {
  const VoxelPos at = origin_of(block, kLuantiBlockEdge);
  const std::int32_t x = at.x - box.min.x, y = at.y - box.min.y, z = at.z - box.min.z;
  const std::int32_t across = (box.max.x - box.min.x) / kSide, up = (box.max.y - box.min.y) / kSide,
                     deep = (box.max.z - box.min.z) / kSide;
  if (std::min({x, y, z}) < 0 || x / kSide >= across || y / kSide >= up || z / kSide >= deep)
    return {};
  return BlockPlace{static_cast<std::size_t>(x / kSide + across * (y / kSide + up * (z / kSide))),
                    x % kSide, y % kSide, z % kSide};
}

Result<std::vector<LitChunk>, std::string> luanti(const std::string& folder) {
  const auto world = luanti_world(folder, PlantsKept::yes);
  if (!world) return failure(world.error());
  const VoxelBox box = *world->bounds;
  std::vector<LitChunk> out = each_chunk(
      box, [&](VoxelPos origin) { return unlit(chunk_of_world(*world, origin, kByteEdge)); });
  auto map = open_luanti_sqlite_map(folder + "/map.sqlite");
  if (!map) return failure(map.error());
  LuantiNodes nodes;
  std::optional<std::string> damaged;
  const auto read = (*map)->each_row([&](const LuantiRow& row) {
    const auto place = place_of(row.block, box);
    if (!place || damaged) return;
    if (const auto decoded = decode_luanti_row(row.data, nodes); !decoded) {
      damaged = std::string("a block of ") + folder + ": " + decoded.error().what;
      return;
    }
    LitChunk& chunk = out[place->chunk];
    for (std::int32_t z = 0; z < kLuantiBlockEdge; ++z) {
      for (std::int32_t y = 0; y < kLuantiBlockEdge; ++y) {
        std::copy_n(nodes.param1.begin() + 256 * z + 16 * y, kLuantiBlockEdge,
                    chunk.light.begin() + static_cast<std::ptrdiff_t>(
                                              voxel_index(place->x, place->y + y, place->z + z)));
      }
    }
  });
  if (!read) return failure(read.error());
  if (damaged) return failure(*damaged);
  return out;
}

Result<std::vector<LitChunk>, std::string> chunks_of(const std::string& name,
                                                     const std::string& folder) {
  if (name == "noise_terrain") return noise_terrain();
  if (name == "luanti") return luanti(folder);
  const auto worlds = MeasuredWorlds::open({name}, folder);
  if (!worlds) return failure(worlds.error());
  return name == "scenarios" ? scenarios(*worlds) : seeded(*worlds->voxels(0));
}

}  // namespace

std::vector<std::string> byte_world_names() {
  std::vector<std::string> out = {"noise_terrain", "luanti"};
  for (const VoxelWorld& world : seeded_worlds()) out.push_back(world.name);
  out.push_back("scenarios");
  return out;
}

Result<ByteWorld, std::string> byte_world(const std::string& name,
                                          const std::string& luanti_folder) {
  auto chunks = chunks_of(name, luanti_folder);
  if (!chunks) return failure(chunks.error());
  return ByteWorld{name, std::move(*chunks)};
}

}  // namespace runstone::bench
