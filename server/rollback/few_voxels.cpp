#include "server/rollback/few_voxels.hpp"

#include <algorithm>
#include <variant>

#include "common/edits/descriptor/edit_geometry.hpp"

namespace runstone {
namespace {

// Single voxels cost less than a whole chunk up to this part of its voxels. The maximum bounds the
// time of an edit, which may meet all of them.
constexpr std::uint32_t kFewVoxelsPart = 32;
constexpr std::size_t kFewVoxelsMax = 4'096;
// Spheres, strokes and pastes cost up to a microsecond for each voxel in their bounding box. This is
// the maximum number of pairs of such an edit and a voxel.
constexpr std::size_t kLargePairsMax = 1'024;
// A generator makes single voxels up to this part of the voxels of a chunk, and whole chunks above.
constexpr std::uint32_t kSingleVoxelsPart = 512;

void append_voxels(const VoxelBox& box, std::vector<VoxelPos>& out) {
  for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
    for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
      for (std::int32_t z = box.min.z; z < box.max.z; ++z) out.push_back({x, y, z});
    }
  }
}

std::size_t voxels_in(const VoxelBox& box) {
  if (box.empty()) return 0;
  return static_cast<std::size_t>(box.max.x - box.min.x) *
         static_cast<std::size_t>(box.max.y - box.min.y) *
         static_cast<std::size_t>(box.max.z - box.min.z);
}

}  // namespace

std::optional<std::vector<VoxelPos>> few_voxels(std::span<const EditRecord* const> records,
                                                std::span<const Sequence> selected,
                                                const VoxelBox& inside, std::int32_t edge) {
  const std::uint32_t volume = Extent::cube(static_cast<unsigned>(edge)).volume();
  const std::size_t voxels_max = std::min<std::size_t>(volume / kFewVoxelsPart, kFewVoxelsMax);
  std::vector<VoxelPos> voxels;
  std::size_t large_edits = 0;
  auto next = selected.begin();
  for (const EditRecord* record : records) {
    const EditDescriptor& edit = record->edit;
    const bool is_box =
        std::holds_alternative<SetVoxel>(edit.shape) || std::holds_alternative<FillBox>(edit.shape);
    large_edits += is_box ? 0 : 1;
    while (next != selected.end() && *next < record->version.seq) ++next;
    if (next == selected.end() || *next != record->version.seq) continue;
    const VoxelBox box = intersect(bounding_box(edit), inside);
    if (voxels.size() + voxels_in(box) > voxels_max) return std::nullopt;
    append_voxels(box, voxels);
  }
  std::sort(voxels.begin(), voxels.end());
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  if (voxels.size() * large_edits > kLargePairsMax) return std::nullopt;
  return voxels;
}

std::vector<Material> materials_of(std::span<const VoxelPos> voxels,
                                   const std::optional<Chunk>& stored, const Generator& generator,
                                   const ChunkKey& key, std::int32_t edge) {
  std::vector<Material> out;
  out.reserve(voxels.size());
  const Extent extent = Extent::cube(static_cast<unsigned>(edge));
  if (!stored && voxels.size() <= extent.volume() / kSingleVoxelsPart) {
    for (const VoxelPos& at : voxels)
      out.push_back(generator.generate(at, {1, 1, 1}).runs.material(0));
    return out;
  }
  const RunChunk made = stored ? RunChunk() : generator.generate(origin_of(key.at, edge), extent);
  const RunChunk& chunk = stored ? stored->voxels : made;
  for (const VoxelPos& at : voxels) out.push_back(material_at(chunk, local_of(at, edge)));
  return out;
}

}  // namespace runstone
