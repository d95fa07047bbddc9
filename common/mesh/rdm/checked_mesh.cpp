#include "common/mesh/rdm/checked_mesh.hpp"

namespace runstone {

Result<VisibilityTable> visibility_table(std::span<const Visibility> materials) {
  if (materials.size() > kMaterialCountMax)
    return fail(ErrorCode::limit_exceeded, "more visibilities than materials can have",
                kMaterialCountMax);
  return VisibilityTable(materials);
}

Result<void> try_mesh_rdm(const RunChunk& chunk, const MeshNeighbours& neighbours,
                          const VisibilityTable& visibility, RdmScratch& scratch, ChunkMesh& out) {
  if (auto valid = validate(chunk); !valid) return valid;
  for (std::size_t d = 0; d < kDirectionCount; ++d) {
    const RunChunk* const neighbour = neighbours[d];
    if (neighbour == nullptr) continue;
    if (auto valid = validate(*neighbour); !valid) return valid;
    const auto across = static_cast<std::size_t>(axis_of(static_cast<Direction>(d)));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axis != across && neighbour->extent.sides()[axis] != chunk.extent.sides()[axis])
        return fail(ErrorCode::bad_value, "neighbour with other sides than the chunk", d);
    }
  }
  mesh_rdm(chunk, neighbours, visibility, scratch, out);
  return {};
}

}  // namespace runstone
