#include "server/replay/export_luanti.hpp"

#include <algorithm>

#include "common/core/assert.hpp"
#include "common/formats/luanti_block.hpp"
#include "common/formats/luanti_block_writer.hpp"
#include "common/formats/luanti_names.hpp"
#include "common/runs/cut.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

/// Returns a block with air outside the part, which lies in the block.
RunChunk only_part(const RunChunk& block, const VoxelBox& whole, const VoxelBox& part) {
  if (part == whole) return block;
  const RunChunk lines = reorder(block, AxisOrder::xyz);
  RunBuilder out(lines.extent, AxisOrder::xyz);
  std::size_t run = 0;
  std::uint32_t at = 0;
  VoxelPos line = whole.min;
  const auto wide = static_cast<std::uint32_t>(whole.max.x - whole.min.x);
  const auto first = static_cast<std::uint32_t>(part.min.x - whole.min.x);
  const auto last = static_cast<std::uint32_t>(part.max.x - whole.min.x);
  for (; line.z < whole.max.z; ++line.z) {
    for (line.y = whole.min.y; line.y < whole.max.y; ++line.y) {
      const std::uint32_t begin = at;
      const bool is_inside = part.contains({part.min.x, line.y, line.z});
      while (at < begin + wide) {
        while (lines.runs.end(run) <= at) ++run;
        const std::uint32_t x = at - begin;
        const bool is_kept = is_inside && x >= first && x < last;
        const std::uint32_t stop = !is_inside || x >= last ? wide : x < first ? first : last;
        const std::uint32_t end = std::min(begin + stop, lines.runs.end(run));
        out.append(end - at, is_kept ? lines.runs.material(run) : kEmpty);
        at = end;
      }
    }
  }
  return out.finish();
}

std::uint64_t solid_voxels(const RunChunk& voxels) {
  std::uint64_t out = 0;
  for (std::size_t i = 0; i < voxels.runs.size(); ++i) {
    if (voxels.runs.material(i) != kEmpty) out += voxels.runs.end(i) - voxels.runs.begin(i);
  }
  return out;
}

}  // namespace

std::string luanti_box_refusal(const VoxelBox& box) {
  const VoxelBox limit{{kLuantiVoxelMin, kLuantiVoxelMin, kLuantiVoxelMin},
                       {kLuantiVoxelMax + 1, kLuantiVoxelMax + 1, kLuantiVoxelMax + 1}};
  if (!box.empty() && intersect(box, limit) == box) return "";
  return "--box: a Luanti world has the coordinates " + std::to_string(kLuantiVoxelMin) + " to " +
         std::to_string(kLuantiVoxelMax) + " along each axis, and the box reaches beyond";
}

Result<std::uint64_t, std::string> export_luanti(const WorldAt& world, WorldReader& reader,
                                                 const MaterialTable& materials,
                                                 const VoxelBox& box, std::int32_t chunk_edge,
                                                 LuantiWorldWriter& writer,
                                                 const ChunkProgress& progress) {
  RUNSTONE_ASSERT(luanti_box_refusal(box).empty() && chunk_edge % kLuantiBlockEdge == 0);
  const auto node_of = [&](Material material) -> LuantiNode {
    if (material == kEmpty) return {"air"};
    if (!materials.knows(material)) return luanti_node_of("material " + std::to_string(material));
    return luanti_node_of(materials[material].name);
  };
  const ChunkCoord first = chunk_of(box.min, chunk_edge);
  const ChunkCoord last = chunk_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, chunk_edge);
  const auto side = [](std::int32_t a, std::int32_t b) {
    return static_cast<std::uint64_t>(b - a) + 1;
  };
  const std::uint64_t total = side(first.x, last.x) * side(first.y, last.y) * side(first.z, last.z);
  std::uint64_t done = 0, solid = 0;
  ReplayScratch scratch;
  for (ChunkCoord at = first; at.z <= last.z; ++at.z) {
    for (at.y = first.y; at.y <= last.y; ++at.y) {
      for (at.x = first.x; at.x <= last.x; ++at.x) {
        if (!progress(done++, total)) return failure("it was ended");
        const auto voxels = world.voxels({0, at}, reader, scratch);
        if (!voxels) return failure(voxels.error().message());
        if (voxels->is_uniform() && voxels->runs.material(0) == kEmpty) continue;
        const VoxelBox part = intersect(box_of(at, chunk_edge), box);
        const ChunkCoord low = chunk_of(part.min, kLuantiBlockEdge);
        const ChunkCoord high =
            chunk_of({part.max.x - 1, part.max.y - 1, part.max.z - 1}, kLuantiBlockEdge);
        for (ChunkCoord block = low; block.z <= high.z; ++block.z) {
          for (block.y = low.y; block.y <= high.y; ++block.y) {
            for (block.x = low.x; block.x <= high.x; ++block.x) {
              const VoxelBox whole = box_of(block, kLuantiBlockEdge);
              const RunChunk cells = only_part(
                  cut(*voxels, local_of(whole.min, chunk_edge), Extent::cube(kLuantiBlockEdge)),
                  whole, intersect(whole, box));
              if (cells.is_uniform() && cells.runs.material(0) == kEmpty) continue;
              solid += solid_voxels(cells);
              const auto put = writer.put(block, encode_luanti_block(cells, node_of));
              if (!put) return failure(put.error());
            }
          }
        }
      }
    }
  }
  return solid;
}

}  // namespace runstone
