#include "common/patterns/column_slice.hpp"

#include <memory>

namespace runstone {
namespace {

constexpr Material kUnknownMaterial = UINT16_MAX;

}  // namespace

VoxelBox slice_box(const VoxelBox& part, bool is_wide) {
  if (!is_wide) return part;
  const VoxelBox world{{-kWorldLimit, -kWorldLimit, -kWorldLimit},
                       {kWorldLimit, kWorldLimit, kWorldLimit}};
  return intersect({{part.min.x - 1, part.min.y - 1, part.min.z - 1},
                    {part.max.x + 1, part.max.y + 1, part.max.z + 1}},
                   world);
}

Result<GroundColumns> read_column_slice(const VoxelBox& read, const VoxelBox& box,
                                        std::int32_t chunk_edge, const ChunkLookup& chunks) {
  return GroundColumns::read(read, chunk_edge, [&](ChunkCoord at) {
    auto chunk = chunks(at);
    if (chunk != nullptr || !intersect(box_of(at, chunk_edge), box).empty()) return chunk;
    return std::shared_ptr<const RunChunk>(std::make_shared<RunChunk>(
        uniform_chunk(Extent::cube(static_cast<std::uint8_t>(chunk_edge)), kUnknownMaterial)));
  });
}

}  // namespace runstone
