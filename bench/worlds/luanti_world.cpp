#include "bench/worlds/luanti_world.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "common/runs/dense.hpp"
#include "common/runs/reorder.hpp"
#include "server/import/import_luanti.hpp"

namespace runstone::bench {
namespace {

constexpr std::int32_t kEdge = 128;  // of the imported chunks
constexpr std::int64_t kVoxelsMax = std::int64_t{1} << 28;

/// The voxels of a box. y is the fastest axis, then x, then z.
struct DenseBox {
  VoxelBox box;
  std::vector<Material> voxels;

  std::size_t index(VoxelPos p) const {
    const auto wide = [](std::int32_t v) { return static_cast<std::size_t>(v); };
    const std::size_t height = wide(box.max.y - box.min.y), width = wide(box.max.x - box.min.x);
    return wide(p.y - box.min.y) + height * (wide(p.x - box.min.x) + width * wide(p.z - box.min.z));
  }
};

void write_chunk(const ChunkCoord& at, const RunChunk& chunk, DenseBox& into) {
  const std::vector<Material> dense = to_dense(reorder(chunk, AxisOrder::yxz));
  const VoxelPos origin = origin_of(at, kEdge);
  const VoxelBox part = intersect(box_of(at, kEdge), into.box);
  if (part.empty()) return;
  const auto local = [&](std::int32_t x, std::int32_t z) {
    const LocalPos p = {static_cast<std::uint8_t>(x - origin.x),
                        static_cast<std::uint8_t>(part.min.y - origin.y),
                        static_cast<std::uint8_t>(z - origin.z)};
    return index_of(p, chunk.extent, AxisOrder::yxz);
  };
  for (std::int32_t z = part.min.z; z < part.max.z; ++z) {
    for (std::int32_t x = part.min.x; x < part.max.x; ++x) {
      std::copy_n(
          dense.begin() + local(x, z), part.max.y - part.min.y,
          into.voxels.begin() + static_cast<std::ptrdiff_t>(into.index({x, part.min.y, z})));
    }
  }
}

}  // namespace

Result<VoxelWorld, std::string> luanti_world(const std::string& folder, PlantsKept plants) {
  std::map<ChunkCoord, RunChunk> chunks;
  const LuantiImportSink sink{[](const MaterialTable&) {},
                              [&](const ChunkKey& key, RunChunk&& chunk) {
                                chunks.emplace(key.at, std::move(chunk));
                                return true;
                              },
                              {}};
  const auto report = import_luanti(
      folder, {.edge = kEdge, .keep_all = plants == PlantsKept::yes, .only_cubes = true}, sink);
  if (!report) return failure(report.error().message());
  DenseBox dense{report->bounds, {}};
  const VoxelBox& box = dense.box;
  if (box.empty()) return failure(folder + ": no blocks");
  const std::int64_t volume = std::int64_t{box.max.x - box.min.x} * (box.max.y - box.min.y);
  if (volume > kVoxelsMax / (box.max.z - box.min.z)) {
    return failure(folder + ": more than 2^28 voxels");
  }
  dense.voxels.resize(static_cast<std::size_t>(volume) *
                      static_cast<std::size_t>(box.max.z - box.min.z));
  for (const auto& [at, chunk] : chunks) write_chunk(at, chunk, dense);

  VoxelWorld out;
  out.name = "luanti";
  out.visibility = std::make_shared<const VisibilityTable>(visibilities(report->materials));
  out.materials = std::make_shared<const MaterialTable>(report->materials);
  out.bounds = dense.box;
  out.column = [dense = std::make_shared<const DenseBox>(std::move(dense))](
                   VoxelPos at, std::span<Material> to) {
    std::copy_n(dense->voxels.begin() + static_cast<std::ptrdiff_t>(dense->index(at)), to.size(),
                to.begin());
  };
  return out;
}

}  // namespace runstone::bench
