#include "client/tools/pattern_work.hpp"

#include <utility>

#include "client/tools/build_words.hpp"

namespace runstone {

namespace {

/// Keeps the shown chunks that meet a box. Returns false if one of them is not shown.
bool keep_inside(const Replica& replica, const VoxelBox& box, PatternWork& work) {
  const ChunkCoord first = chunk_of(box.min, work.chunk_edge);
  const ChunkCoord last = chunk_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, work.chunk_edge);
  for (ChunkCoord at = first; at.z <= last.z; ++at.z) {
    for (at.y = first.y; at.y <= last.y; ++at.y) {
      for (at.x = first.x; at.x <= last.x; ++at.x) {
        ShownPtr chunk = replica.shown({0, at});
        // In a box of the whole world the first chunk that is not shown ends the loop.
        if (!chunk) return false;
        work.chunks.emplace(at, std::move(chunk));
      }
    }
  }
  return true;
}

/// Keeps the shown chunks around those that meet a box. Requires keep_inside().
void keep_around(const Replica& replica, const VoxelBox& box, PatternWork& work) {
  const ChunkCoord first = chunk_of(box.min, work.chunk_edge);
  const ChunkCoord last = chunk_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, work.chunk_edge);
  for (ChunkCoord at{first.x - 1, 0, first.z - 1}; at.z <= last.z + 1; ++at.z) {
    for (at.y = first.y - 1; at.y <= last.y + 1; ++at.y) {
      for (at.x = first.x - 1; at.x <= last.x + 1; ++at.x) {
        if (work.chunks.contains(at)) continue;
        if (ShownPtr chunk = replica.shown({0, at})) work.chunks.emplace(at, std::move(chunk));
      }
    }
  }
}

}  // namespace

Result<PatternWorkPtr, std::string> pattern_work(const Replica& replica,
                                                 std::vector<VoxelBox> boxes, BoundMix mix,
                                                 std::optional<BoundFilter> filter,
                                                 VoxelRowsPtr only) {
  auto out = std::make_shared<PatternWork>(PatternWork{std::move(boxes),
                                                       std::move(mix),
                                                       std::move(filter),
                                                       std::move(only),
                                                       replica.chunk_edge(),
                                                       {},
                                                       {},
                                                       {}});
  for (const VoxelBox& box : out->boxes) {
    if (!keep_inside(replica, box, *out)) return failure("a chunk of the box is not loaded");
  }
  if (out->filter && out->filter->reads_neighbours()) {
    for (const VoxelBox& box : out->boxes) keep_around(replica, box, *out);
  }
  return PatternWorkPtr(std::move(out));
}

Result<PatternWorkPtr, std::string> with_symmetry(PatternWorkPtr work, const Symmetry& symmetry,
                                                  const MaterialTable& materials) {
  if (symmetry.kind == SymmetryKind::none) return work;
  for (const VoxelBox& box : work->boxes) {
    const VoxelPos sides{box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z};
    for (const MirrorAxes axes : copies_of(symmetry.kind)) {
      if (!is_in_world(mirrored_corner(box.min, sides, axes, symmetry), sides))
        return failure("a mirrored copy reaches outside the world");
    }
  }
  auto out = std::make_shared<PatternWork>(*work);
  out->symmetry = symmetry;
  out->materials = materials;
  return PatternWorkPtr(std::move(out));
}

Result<Replacing> replacing_in(const PatternWorkPtr& work, const VoxelBox& part) {
  const auto chunk_at = [work](ChunkCoord at) {
    const auto found = work->chunks.find(at);
    return found == work->chunks.end() ? nullptr : found->second;
  };
  return Replacing::of(part, work->mix, work->filter, work->chunk_edge, chunk_at, work->only);
}

std::string pattern_failure(const Error& error) {
  return std::string(error.what) +
         (error.code == ErrorCode::limit_exceeded ? ": choose a smaller box" : "");
}

}  // namespace runstone
