// Calls of runstone.h on chunks.
#include <algorithm>
#include <array>
#include <vector>

#include "bindings/c/buffer.hpp"
#include "bindings/c/chunk_handle.hpp"
#include "bindings/c/runstone.h"
#include "bindings/c/versioned.hpp"
#include "common/runs/checked_runs.hpp"
#include "common/runs/dense.hpp"
#include "common/runs/reorder.hpp"

using namespace runstone;
using namespace runstone::c_interface;

namespace {

Extent extent_of(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  const auto extent = chunk_extent(x, y, z);
  if (!extent) refuse(RUNSTONE_BAD_ARGUMENT, "side", "is not 8 to 128 voxels");
  return *extent;
}

RunList runs_from(std::span<const std::uint32_t> ends, const std::uint16_t* materials,
                  std::uint32_t volume) {
  check_at_most(ends.size(), std::size_t{volume}, "count", "is larger than the volume");
  RunList runs(volume);
  runs.reserve(ends.size());
  for (std::size_t i = 0; i < ends.size(); ++i) {
    // validate() finds what else may be wrong, but the narrow form holds no larger end.
    if (ends[i] > volume)
      refuse("ends", Error{ErrorCode::broken_invariant, "run reaches behind the chunk", i});
    runs.push_back({ends[i], materials[i]});
  }
  return runs;
}

}  // namespace

runstone_status runstone_chunk_create_filled(uint32_t side_x, uint32_t side_y, uint32_t side_z,
                                             uint16_t material, runstone_chunk** out) {
  return answer([&] {
    output(out, "out");
    create(out, uniform_chunk(extent_of(side_x, side_y, side_z), material));
  });
}

runstone_status runstone_chunk_create_from_array(uint32_t side_x, uint32_t side_y, uint32_t side_z,
                                                 uint32_t order, const uint16_t* voxels,
                                                 size_t count, runstone_chunk** out) {
  return answer([&] {
    output(out, "out");
    const Extent extent = extent_of(side_x, side_y, side_z);
    const AxisOrder axis_order = order_of(order);
    given(voxels, "voxels");
    if (count != extent.volume())
      refuse(RUNSTONE_BAD_ARGUMENT, "count", "is not the volume of the chunk");
    auto chunk = from_dense(extent, axis_order, {voxels, count});
    if (!chunk) refuse("voxels", chunk.error());
    create(out, *std::move(chunk));
  });
}

runstone_status runstone_chunk_create_from_runs(uint32_t side_x, uint32_t side_y, uint32_t side_z,
                                                uint32_t order, const uint32_t* ends,
                                                const uint16_t* materials, size_t count,
                                                runstone_chunk** out) {
  return answer([&] {
    output(out, "out");
    const Extent extent = extent_of(side_x, side_y, side_z);
    const AxisOrder axis_order = order_of(order);
    given(ends, "ends");
    given(materials, "materials");
    RunChunk chunk{extent, axis_order, runs_from({ends, count}, materials, extent.volume())};
    if (const auto valid = validate(chunk); !valid) refuse("runs", valid.error());
    create(out, std::move(chunk));
  });
}

runstone_status runstone_chunk_clone(const runstone_chunk* chunk, runstone_chunk** out) {
  return answer([&] {
    output(out, "out");
    create(out, whole(chunk, "chunk"));
  });
}

runstone_status runstone_chunk_free(runstone_chunk* chunk) { return free_handle(chunk, "chunk"); }

runstone_status runstone_chunk_get_info(const runstone_chunk* chunk, runstone_chunk_info* out) {
  return answer([&] {
    const RunChunk& runs = whole(chunk, "chunk").runs;
    fill_versioned(versioned(out, "out"), {0,
                                           {runs.extent.x, runs.extent.y, runs.extent.z},
                                           static_cast<std::uint32_t>(runs.order),
                                           runs.volume(),
                                           static_cast<std::uint32_t>(runs.runs.size()),
                                           runs.is_uniform() ? 1U : 0U});
  });
}

runstone_status runstone_chunk_get(const runstone_chunk* chunk, uint32_t x, uint32_t y, uint32_t z,
                                   uint16_t* material) {
  return answer([&] {
    const RunChunk& runs = whole(chunk, "chunk").runs;
    if (x >= runs.extent.x || y >= runs.extent.y || z >= runs.extent.z)
      refuse(RUNSTONE_BAD_ARGUMENT, "position", "is outside the chunk");
    given(material, "material") = material_at(
        runs,
        {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), static_cast<std::uint8_t>(z)});
  });
}

runstone_status runstone_chunk_fill(runstone_chunk* chunk, uint32_t first, uint32_t voxels,
                                    uint16_t material) {
  return answer([&] {
    runstone_chunk& changed = whole(chunk, "chunk");
    const std::uint32_t volume = changed.runs.volume();
    if (voxels == 0 || first >= volume || voxels > volume - first)
      refuse(RUNSTONE_BAD_ARGUMENT, "voxels", "are none, or reach behind the end of the chunk");
    change_runs(changed, [&] {
      if (!fill(changed.runs, first, voxels, material)) return;
      changed.digest.reset();
      changed.forget_past();
    });
  });
}

runstone_status runstone_chunk_to_array(const runstone_chunk* chunk, uint32_t order, uint16_t* out,
                                        size_t capacity, size_t* count) {
  return answer([&] {
    const RunChunk& runs = whole(chunk, "chunk").runs;
    const AxisOrder axis_order = order_of(order);
    if (!has_room(out, capacity, runs.volume(), count)) return;
    count_dense_expansion();
    const auto write = [out](const RunChunk& from) {
      from.runs.visit([out](const auto& list) {
        for (std::size_t i = 0, begin = 0; i < list.size(); begin = list.end(i++))
          std::fill(out + begin, out + list.end(i), list.material(i));
      });
    };
    if (runs.order == axis_order) {
      write(runs);
    } else {
      write(reorder(runs, axis_order));
    }
  });
}

runstone_status runstone_chunk_runs(const runstone_chunk* chunk, uint32_t* ends,
                                    uint16_t* materials, size_t capacity, size_t* count) {
  return answer([&] {
    const RunList& runs = whole(chunk, "chunk").runs.runs;
    if (capacity != 0) given(materials, "materials");
    if (!has_room(ends, capacity, runs.size(), count)) return;
    runs.visit([&](const auto& list) {
      for (std::size_t i = 0; i < list.size(); ++i) {
        ends[i] = list.end(i);
        materials[i] = list.material(i);
      }
    });
  });
}

runstone_status runstone_chunk_reorder(runstone_chunk* chunk, uint32_t order) {
  return answer([&] {
    runstone_chunk& changed = whole(chunk, "chunk");
    const AxisOrder axis_order =
        order == RUNSTONE_ORDER_CHEAPEST ? cheapest_order(changed.runs) : order_of(order);
    if (axis_order == changed.runs.order) return;
    changed.runs = reorder(changed.runs, axis_order);
    changed.forget_past();
  });
}

runstone_status runstone_chunk_digest(const runstone_chunk* chunk, uint64_t digest[2]) {
  return answer([&] {
    const runstone_chunk& of = whole(chunk, "chunk");
    given(digest, "digest");
    const Digest sum = of.digest ? *of.digest : digest_of(of.runs);
    std::copy(sum.lane.begin(), sum.lane.end(), digest);
  });
}

runstone_status runstone_chunk_equal(const runstone_chunk* a, const runstone_chunk* b,
                                     uint32_t* is_equal) {
  return answer([&] {
    const RunChunk& left = whole(a, "a").runs;
    const RunChunk& right = whole(b, "b").runs;
    const bool equal = left.extent == right.extent &&
                       (left.order == right.order ? left.runs == right.runs
                                                  : left.runs == reorder(right, left.order).runs);
    given(is_equal, "is_equal") = equal ? 1 : 0;
  });
}
