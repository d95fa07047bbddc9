#include "common/runs/checked_runs.hpp"

#include <algorithm>

#include "common/runs/cut.hpp"

namespace runstone {

Result<Extent> chunk_extent(unsigned x, unsigned y, unsigned z) {
  if (std::min({x, y, z}) < kSideMin || std::max({x, y, z}) > kSideMax)
    return fail(ErrorCode::bad_value, "chunk side outside 8..128");
  const auto side = [](unsigned voxels) { return static_cast<std::uint8_t>(voxels); };
  return Extent{side(x), side(y), side(z)};
}

Result<bool> try_fill(RunChunk& chunk, VoxelIndex first, std::uint32_t count, Material material,
                      EditArea* area) {
  if (count == 0) return fail(ErrorCode::bad_value, "fill of no voxels");
  if (first >= chunk.volume() || count > chunk.volume() - first)
    return fail(ErrorCode::bad_value, "fill beyond the end of the chunk", first);
  return fill(chunk, first, count, material, area);
}

Result<Material> try_material_at(const RunChunk& chunk, LocalPos at) {
  const Extent& e = chunk.extent;
  if (at.x >= e.x || at.y >= e.y || at.z >= e.z)
    return fail(ErrorCode::bad_value, "position outside the chunk");
  return material_at(chunk, at);
}

Result<RunChunk> try_cut(const RunChunk& chunk, LocalPos first, Extent extent,
                         std::uint8_t mirrored) {
  if (!extent.valid_part()) return fail(ErrorCode::bad_value, "cut with a side outside 1..128");
  const Extent& e = chunk.extent;
  if (first.x + extent.x > e.x || first.y + extent.y > e.y || first.z + extent.z > e.z)
    return fail(ErrorCode::bad_value, "cut reaches out of the chunk");
  return cut(chunk, first, extent, mirrored);
}

}  // namespace runstone
