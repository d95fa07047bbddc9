// Calls of runstone.h on collision.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "bindings/c/buffer.hpp"
#include "bindings/c/chunk_handle.hpp"
#include "bindings/c/runstone.h"
#include "bindings/c/versioned.hpp"
#include "common/collision/merged_boxes.hpp"
#include "common/collision/ray_walk.hpp"
#include "common/collision/sweep.hpp"

using namespace runstone;
using namespace runstone::c_interface;

namespace {

/// The longest ray. It bounds the cost.
constexpr double kReachMax = 512;

/// The chunks of a space, by their place.
class HeldChunks final : public VoxelSpace {
 public:
  explicit HeldChunks(std::int32_t edge) : VoxelSpace(edge) {}
  const RunChunk* chunk(ChunkCoord at) const override {
    const auto found = chunks_.find(at);
    return found == chunks_.end() ? nullptr : &found->second;
  }
  void set(ChunkCoord at, RunChunk chunk) { chunks_.insert_or_assign(at, std::move(chunk)); }
  void forget(ChunkCoord at) { chunks_.erase(at); }

 private:
  std::map<ChunkCoord, RunChunk> chunks_;
};

}  // namespace

struct runstone_space : Handle<0x63617073> {
  explicit runstone_space(std::int32_t edge) : chunks(edge) {}
  HeldChunks chunks;
  MaterialSet solid;
};

namespace {

MaterialSet solid_set(const uint8_t* solid, std::size_t count, std::uint32_t others) {
  check_at_most(count, kMaterialCountMax, "count", "is more than there are materials");
  if (count > 0 && given(solid, "solid") != 0)
    refuse(RUNSTONE_BAD_ARGUMENT, "solid",
           "has another value than 0 for material 0, which is empty");
  std::vector<bool> has;
  for (const std::uint8_t one : elements(solid, count, "solid")) has.push_back(one != 0);
  return {std::move(has), others != 0};
}

WorldPos world_pos(const runstone_vec& at) { return {at.x, at.y, at.z}; }
runstone_pos voxel_pos(const VoxelPos& at) { return {at.x, at.y, at.z}; }

/// Refuses a body or a move that sweep() does not take, or that costs without a bound.
BodyBox body_box(const runstone_body& body, const runstone_vec& move) {
  const BodyBox box{world_pos(body.min), world_pos(body.max)};
  if (const auto valid = validate_move(box, world_pos(move)); !valid)
    refuse(RUNSTONE_BAD_ARGUMENT, "body", valid.error().what);
  for (const double size :
       {body.max.x - body.min.x, body.max.y - body.min.y, body.max.z - body.min.z})
    check_at_most(size, kSweepMax, "body", "is larger than 256 voxels on an axis");
  return box;
}

LookDirection unit_direction(const runstone_vec& v) {
  const double longest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z) || longest == 0)
    refuse(RUNSTONE_BAD_ARGUMENT, "direction", "is 0, or has a number that is not finite");
  // Divided twice, so that squares of very large and very small numbers stay numbers.
  const double x = v.x / longest, y = v.y / longest, z = v.z / longest;
  const double length = std::sqrt(x * x + y * y + z * z);
  return {x / length, y / length, z / length};
}

}  // namespace

runstone_status runstone_space_create(uint32_t edge, runstone_space** out) {
  return answer([&] {
    output(out, "out");
    create(out, edge_of(edge));
  });
}

runstone_status runstone_space_free(runstone_space* space) { return free_handle(space, "space"); }

runstone_status runstone_space_set(runstone_space* space, runstone_pos at,
                                   const runstone_chunk* chunk) {
  return answer([&] {
    HeldChunks& chunks = live(space, "space").chunks;
    const ChunkCoord place = place_of(at, chunks.edge());
    if (chunk == nullptr) return chunks.forget(place);
    const RunChunk& runs = whole(chunk, "chunk").runs;
    if (runs.extent != Extent::cube(static_cast<unsigned>(chunks.edge())))
      refuse(RUNSTONE_BAD_ARGUMENT, "chunk", "is no cube of the edge of the space");
    chunks.set(place, runs);
  });
}

runstone_status runstone_space_set_solid(runstone_space* space, const uint8_t* solid, size_t count,
                                         uint32_t others) {
  return answer([&] {
    runstone_space& changed = live(space, "space");
    changed.solid = solid_set(solid, count, others);
  });
}

runstone_status runstone_space_sweep(const runstone_space* space, runstone_body body,
                                     runstone_vec move, runstone_sweep* out) {
  return answer([&] {
    const runstone_space& in = live(space, "space");
    const BodyBox box = body_box(body, move);
    versioned(out, "out");
    runstone_sweep result{0, 0, 1, RUNSTONE_DIRECTION_NONE, {}};
    if (const auto hit = sweep(in.chunks, in.solid, box, world_pos(move))) {
      result = {0, 1, hit->fraction, static_cast<std::uint32_t>(hit->face), voxel_pos(hit->voxel)};
    }
    fill_versioned(*out, result);
  });
}

runstone_status runstone_space_slide(const runstone_space* space, runstone_body body,
                                     runstone_vec move, runstone_slide* out) {
  return answer([&] {
    const runstone_space& in = live(space, "space");
    const BodyBox box = body_box(body, move);
    versioned(out, "out");
    const Slide end = slide(in.chunks, in.solid, box, world_pos(move));
    runstone_slide result{0, 0, {end.moved.x, end.moved.y, end.moved.z}};
    for (std::size_t d = 0; d < end.is_stopped.size(); ++d)
      result.stopped |= end.is_stopped[d] ? 1U << d : 0U;
    fill_versioned(*out, result);
  });
}

runstone_status runstone_space_overlaps(const runstone_space* space, runstone_body body,
                                        uint32_t* is_overlapping) {
  return answer([&] {
    const runstone_space& in = live(space, "space");
    const BodyBox box = body_box(body, {});
    given(is_overlapping, "overlaps") = overlaps(in.chunks, in.solid, box) ? 1 : 0;
  });
}

runstone_status runstone_space_pick(const runstone_space* space, runstone_vec eye,
                                    runstone_vec direction, double reach, runstone_ray* out) {
  return answer([&] {
    const runstone_space& in = live(space, "space");
    if (!std::isfinite(eye.x) || !std::isfinite(eye.y) || !std::isfinite(eye.z))
      refuse(RUNSTONE_BAD_ARGUMENT, "eye", "has a number that is not finite");
    const LookDirection look = unit_direction(direction);
    if (!(reach >= 0 && reach <= kReachMax))
      refuse(RUNSTONE_BAD_ARGUMENT, "reach", "is not 0 to 512 voxels");
    versioned(out, "out");
    runstone_ray result{0, 0, 0, RUNSTONE_DIRECTION_NONE, {}, 0, 0};
    const auto passes = [&in](Material material) { return !in.solid.contains(material); };
    if (const auto hit = first_hit(in.chunks, {}, world_pos(eye), look, reach, passes)) {
      result.is_hit = 1;
      result.distance = hit->distance;
      if (hit->face) result.direction = static_cast<std::uint32_t>(*hit->face);
      result.voxel = voxel_pos(hit->voxel);
      result.material = hit->material;
    }
    fill_versioned(*out, result);
  });
}

runstone_status runstone_chunk_boxes(const runstone_chunk* chunk, const uint8_t* solid,
                                     size_t solid_count, uint32_t others, runstone_local_box* out,
                                     size_t capacity, size_t* count) {
  return answer([&] {
    const RunChunk& runs = whole(chunk, "chunk").runs;
    const MaterialSet set = solid_set(solid, solid_count, others);
    given(count, "count");
    std::vector<MergedBox> boxes;
    if (const auto merged = merge_boxes(runs, set, kMergedBoxesMax, boxes); !merged)
      refuse("chunk", merged.error());
    if (!has_room(out, capacity, boxes.size(), count)) return;
    for (const MergedBox& box : boxes) {
      *out++ = {{box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}};
    }
  });
}
