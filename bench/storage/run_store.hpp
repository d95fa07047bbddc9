// RunStore: the product's runs, in the cheapest axis order. A voxel is found by bisection. A brush
// finds the stretches that change and replaces the runs of its edit areas at once, as apply_stack()
// does with one edit, but without digest and dirty layers. Source: thesis 3.7.1, 7.3.
#pragma once
#include <algorithm>
#include <vector>

#include "bench/storage/heap_bytes.hpp"
#include "bench/storage/strides.hpp"
#include "bench/storage/voxel_store.hpp"
#include "common/core/assert.hpp"
#include "common/edits/apply/run_patch.hpp"
#include "common/runs/run_cursor.hpp"

namespace runstone::bench::storage {

class RunStore {
 public:
  explicit RunStore(const RunChunk& chunk) : strides_(chunk.extent, chunk.order), chunk_(chunk) {}

  Material at(LocalPos at) const {
    return chunk_.runs.visit([voxel = strides_.index(at)]<class Runs>(Runs runs) {
      RunCursor<Runs> cursor(runs);
      cursor.jump(voxel);
      return cursor.material();
    });
  }
  void set(LocalPos at, Material material) { fill(chunk_, strides_.index(at), 1, material); }
  void paint(const Ball& ball, Material material) {
    thread_local Scratch scratch;
    scratch.changes.clear();
    find_changes(ball, material, scratch.changes);
    scratch.areas.clear();
    scratch.runs.clear();
    plan_patch(chunk_, scratch.changes, scratch.areas, scratch.runs);
    write_patch(chunk_, scratch.areas, scratch.runs, cheaper_write(chunk_, scratch.areas),
                scratch.whole);
  }
  template <class F>
  void walk(F&& stretch) const {
    chunk_.runs.visit([&](const auto& runs) {
      std::uint32_t begin = 0;
      for (std::size_t i = 0; i < runs.size(); ++i) {
        stretch(runs.end(i) - begin, runs.material(i));
        begin = runs.end(i);
      }
    });
  }
  std::size_t byte_size() const {
    const std::size_t bytes = chunk_.runs.byte_capacity();
    if (chunk_.runs.is_narrow()) return sizeof *this + heap_bytes(bytes);
    const std::size_t materials = bytes / 6 * sizeof(Material);  // both lists have one length
    return sizeof *this + heap_bytes(bytes - materials) + heap_bytes(materials);
  }
  const RunChunk& chunk() const { return chunk_; }

 private:
  struct Scratch {
    std::vector<Change> changes;
    std::vector<EditArea> areas;
    std::vector<Run> runs, whole;
  };

  /// Finds the longest stretches of the ball's rows that have another material.
  void find_changes(const Ball& ball, Material material, std::vector<Change>& out) const {
    const OrderedExtent e = ordered(chunk_.extent, chunk_.order);
    chunk_.runs.visit([&]<class Runs>(Runs runs) {
      RunCursor<Runs> cursor(runs);
      ball.for_each_row(chunk_.extent, chunk_.order, [&](OrderedPos from, std::uint32_t count) {
        VoxelIndex first = index_of(from, e);
        const VoxelIndex last = first + count;
        for (cursor.seek(first); first < last;) {
          const VoxelIndex end = std::min(cursor.end(), last);
          if (cursor.material() != material) {
            if (!out.empty() && out.back().last == first) {
              out.back().last = end;
            } else {
              out.push_back({first, end, material});
            }
          }
          first = end;
          if (first < last) cursor.next();
        }
      });
    });
  }

  Strides strides_;
  RunChunk chunk_;
};
static_assert(VoxelStore<RunStore>);

}  // namespace runstone::bench::storage
