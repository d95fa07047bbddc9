#include "client/replica/copy_box.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "common/builds/build_builder.hpp"
#include "common/core/build_info.hpp"
#include "common/runs/cut.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

Extent extent_of(const VoxelBox& box) {
  return {static_cast<std::uint8_t>(box.max.x - box.min.x),
          static_cast<std::uint8_t>(box.max.y - box.min.y),
          static_cast<std::uint8_t>(box.max.z - box.min.z)};
}

bool inside_world(const VoxelBox& box) {
  for (const std::int32_t c : {box.min.x, box.min.y, box.min.z}) {
    if (c < -kWorldLimit || c >= kWorldLimit) return false;
  }
  for (const std::int32_t c : {box.max.x, box.max.y, box.max.z}) {
    if (c > kWorldLimit) return false;
  }
  return true;
}

/// Returns true if a grid of these chunks fits a build of so many bytes.
bool fits_grid(ChunkCoord first, ChunkCoord last, std::size_t bytes_max) {
  std::uint64_t places = 1;
  for (const std::int64_t count : {std::int64_t{last.x} - first.x, std::int64_t{last.y} - first.y,
                                   std::int64_t{last.z} - first.z}) {
    places *= static_cast<std::uint64_t>(count + 1);
    if (places > bytes_max / sizeof(std::uint32_t)) return false;
  }
  return true;
}

/// Returns the voxels as cell numbers, or nullopt if there are too many materials.
std::optional<RunChunk> numbered(const RunChunk& voxels, BuildBuilder& out) {
  RunBuilder cells(voxels.extent, voxels.order);
  const bool done = voxels.runs.visit([&](const auto& runs) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const auto number = out.number_of(runs.material(i));
      if (!number) return false;
      cells.append_to(runs.end(i), *number);
    }
    return true;
  });
  if (!done) return std::nullopt;
  return cells.finish();
}

}  // namespace

Result<BuildPtr> copy_box(const Replica& replica, const VoxelBox& box, std::size_t bytes_max) {
  if (box.empty()) return fail(ErrorCode::bad_value, "box to copy is empty");
  if (!replica.opened()) return fail(ErrorCode::bad_value, "no world is open");
  if (!inside_world(box))
    return fail(ErrorCode::bad_value, "box to copy reaches outside the world");
  if (std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z}) >
      kBuildSideMax)
    return fail(ErrorCode::limit_exceeded, "build is longer than 1,048,576 voxels");
  const std::int32_t edge = replica.chunk_edge();
  const ChunkCoord first = chunk_of(box.min, edge);
  const ChunkCoord last = chunk_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, edge);
  if (!fits_grid(first, last, bytes_max))
    return fail(ErrorCode::limit_exceeded, "build takes too much memory");
  auto out = BuildBuilder::of(world_cuts(box, edge), bytes_max);
  if (!out) return failure(out.error());
  for (ChunkCoord at = first; at.z <= last.z; ++at.z) {
    for (at.y = first.y; at.y <= last.y; ++at.y) {
      for (at.x = first.x; at.x <= last.x; ++at.x) {
        const ShownPtr chunk = replica.shown({0, at});
        if (!chunk) return fail(ErrorCode::not_found, "a chunk of the box to copy is not loaded");
        const VoxelBox whole = box_of(at, edge);
        const VoxelBox part = intersect(box, whole);
        auto cells = numbered(
            part == whole ? *chunk : cut(*chunk, local_of(part.min, edge), extent_of(part)), *out);
        if (!cells) return fail(ErrorCode::limit_exceeded, "build has too many materials");
        const SectionPos place{static_cast<std::uint32_t>(at.x - first.x),
                               static_cast<std::uint32_t>(at.y - first.y),
                               static_cast<std::uint32_t>(at.z - first.z)};
        if (const auto put = out->put(place, *std::move(cells)); !put) return failure(put.error());
      }
    }
  }
  return out->finish();
}

}  // namespace runstone
