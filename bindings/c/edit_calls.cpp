// Calls of runstone.h on edits.
#include <vector>

#include "bindings/c/buffer.hpp"
#include "bindings/c/chunk_handle.hpp"
#include "bindings/c/edits_handle.hpp"
#include "bindings/c/runstone.h"
#include "bindings/c/versioned.hpp"
#include "common/core/thread_scratch.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"

using namespace runstone;
using namespace runstone::c_interface;

namespace {

/// More chunks than this are not listed: their list would take more than 12 MB.
constexpr std::uint64_t kTouchedChunksMax = 1 << 20;

VoxelPos voxel_of(const runstone_pos& at) { return {at.x, at.y, at.z}; }
runstone_pos pos_of(const VoxelPos& at) { return {at.x, at.y, at.z}; }

/// Adds an edit of a brush, if it is valid.
void add(runstone_edits& edits, EditShape shape, const runstone_brush* brush) {
  const runstone_brush& with = versioned(brush, "brush");
  check_at_most(with.mask, std::uint32_t{RUNSTONE_MASK_ONLY_MATERIAL}, "brush",
                "has no known mask");
  const Mask mask{static_cast<MaskKind>(with.mask), with.mask_material};
  EditDescriptor edit{std::move(shape), mask, with.material};
  if (const auto valid = validate(edit); !valid) refuse("edit", valid.error());
  edits.list.push_back(std::move(edit));
}

std::uint16_t radius_of(std::uint32_t radius) {
  check_at_most(radius, std::uint32_t{kEditRadiusMax}, "radius", "is larger than 512");
  return static_cast<std::uint16_t>(radius);
}

void write_layers(const DirtyLayers& dirty, runstone_changes& out) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t layer = 0; layer < kSideMax; ++layer) {
      if (dirty.layer[axis][layer])
        out.layers[axis][layer / 8] |= static_cast<std::uint8_t>(1U << layer % 8);
    }
  }
}

}  // namespace

runstone_status runstone_edits_create(runstone_edits** out) {
  return answer([&] {
    output(out, "out");
    create(out);
  });
}

runstone_status runstone_edits_free(runstone_edits* edits) { return free_handle(edits, "edits"); }

runstone_status runstone_edits_clear(runstone_edits* edits) {
  return answer([&] { live(edits, "edits").list.clear(); });
}

runstone_status runstone_edits_count(const runstone_edits* edits, size_t* count) {
  return answer([&] {
    const std::size_t edit_count = live(edits, "edits").list.size();
    given(count, "count") = edit_count;
  });
}

runstone_status runstone_edits_add_voxel(runstone_edits* edits, runstone_pos at,
                                         const runstone_brush* brush) {
  return answer([&] { add(live(edits, "edits"), SetVoxel{voxel_of(at)}, brush); });
}

runstone_status runstone_edits_add_box(runstone_edits* edits, runstone_box box,
                                       const runstone_brush* brush) {
  return answer(
      [&] { add(live(edits, "edits"), FillBox{{voxel_of(box.min), voxel_of(box.max)}}, brush); });
}

runstone_status runstone_edits_add_sphere(runstone_edits* edits, runstone_pos centre,
                                          uint32_t radius, const runstone_brush* brush) {
  return answer(
      [&] { add(live(edits, "edits"), FillSphere{voxel_of(centre), radius_of(radius)}, brush); });
}

runstone_status runstone_edits_add_stroke(runstone_edits* edits, const runstone_pos* points,
                                          size_t count, uint32_t radius,
                                          const runstone_brush* brush) {
  return answer([&] {
    runstone_edits& to = live(edits, "edits");
    given(points, "points");
    check_at_most(count, kStrokePointsMax, "count", "is more points than a stroke has");
    FillStroke stroke;
    stroke.radius = radius_of(radius);
    for (std::size_t i = 0; i < count; ++i) stroke.points.push_back(voxel_of(points[i]));
    add(to, std::move(stroke), brush);
  });
}

runstone_status runstone_edits_add_bytes(runstone_edits* edits, const uint8_t* bytes,
                                         size_t count) {
  return answer([&] {
    runstone_edits& to = live(edits, "edits");
    auto edit = decode_voxel_edit(elements(bytes, count, "bytes"));
    if (!edit) refuse("bytes", edit.error());
    to.list.push_back(*std::move(edit));
  });
}

runstone_status runstone_edits_bytes(const runstone_edits* edits, size_t index, uint8_t* out,
                                     size_t capacity, size_t* count) {
  return answer([&] {
    const EditDescriptor& edit = edit_at(edits, index);
    given(count, "count");
    write_elements(std::span<const std::uint8_t>(encode(edit)), out, capacity, count);
  });
}

runstone_status runstone_edits_bounds(const runstone_edits* edits, size_t index,
                                      runstone_box* bounds) {
  return answer([&] {
    const VoxelBox box = bounding_box(edit_at(edits, index));
    given(bounds, "bounds") = {pos_of(box.min), pos_of(box.max)};
  });
}

runstone_status runstone_edits_touched_chunks(const runstone_edits* edits, size_t index,
                                              uint32_t edge, runstone_pos* out, size_t capacity,
                                              size_t* count) {
  return answer([&] {
    const EditDescriptor& edit = edit_at(edits, index);
    const std::int32_t chunk_edge = edge_of(edge);
    given(count, "count");
    if (touched_chunks_bound(edit, chunk_edge) > kTouchedChunksMax)
      refuse(RUNSTONE_LIMIT_EXCEEDED, "edit", "may touch more than 1,048,576 chunks");
    const std::vector<ChunkCoord> chunks = touched_chunks(edit, chunk_edge);
    if (!has_room(out, capacity, chunks.size(), count)) return;
    for (std::size_t i = 0; i < chunks.size(); ++i)
      out[i] = {chunks[i].x, chunks[i].y, chunks[i].z};
  });
}

runstone_status runstone_chunk_apply(runstone_chunk* chunk, runstone_pos at,
                                     const runstone_edits* edits, runstone_changes* changes) {
  return answer([&] {
    runstone_chunk& changed = whole(chunk, "chunk");
    const Extent& extent = changed.runs.extent;
    if (extent.x != extent.y || extent.y != extent.z)
      refuse(RUNSTONE_BAD_ARGUMENT, "chunk", "is no cube, as chunks of a world are");
    const std::int32_t edge = edge_of(extent.x);
    const VoxelPos origin = origin_of(place_of(at, edge), edge);
    const auto& list = live(edits, "edits").list;
    if (changes != nullptr) versioned(changes, "changes");
    Digest digest = changed.digest ? *changed.digest : digest_of(changed.runs);
    ApplyResult result;
    change_runs(changed, [&] {
      try {
        with_scratch<ApplyScratch>([&](ApplyScratch& scratch) {
          apply_stack(changed.runs, digest, origin, list, scratch, result);
        });
      } catch (...) {
        // The search for the changes reads the runs alone. It ends before result.changed is set.
        changed.is_damaged = result.changed;
        throw;
      }
      if (result.changed) changed.note_change(result.dirty);
      changed.digest = digest;
    });
    if (changes == nullptr) return;
    runstone_changes out{};
    out.is_changed = result.changed ? 1 : 0;
    out.voxels = result.voxels_changed;
    write_layers(result.dirty, out);
    fill_versioned(*changes, out);
  });
}
