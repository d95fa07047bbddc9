// ApplyScratch: the buffers that apply_stack() keeps between calls. With them a steady state
// allocates nothing, except for a paste, whose part in the chunk is cut out in each call. Callers
// make one per thread and pass it in. Only common/edits uses its contents.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/ids.hpp"
#include "common/edits/apply/layer_canvas.hpp"
#include "common/edits/apply/layer_plan.hpp"
#include "common/edits/descriptor/ordered_shape.hpp"
#include "common/runs/material_factors.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// One part of an edit of the stack, clipped to the current chunk. A stroke has a part for each
/// segment, a paste one for each box, and any other edit has one part.
struct StackPart {
  OrderedShape shape;
  Mask mask;
  Material material = kEmpty;
};

/// Voxels [first, last) of the flattened chunk become `material`. None of them had that material
/// before.
struct Change {
  VoxelIndex first = 0, last = 0;
  Material material = kEmpty;
  friend bool operator==(const Change&, const Change&) = default;
};

/// Voxels [first, last) of one line that part `part` of the stack covers. `next` chains the entries
/// of a line from the bottom of the stack to its top.
struct LineEntry {
  std::uint32_t next = 0;  // entry number + 1; 0 ends the chain
  std::uint32_t part = 0;
  std::uint8_t first = 0, last = 0;
};

struct ApplyScratch {
  std::vector<StackPart> stack;       // the parts that may touch the chunk, bottom first
  std::vector<IndexSpan> spans;       // of a single edit
  std::vector<Change> changes;        // ascending, disjoint
  std::vector<Run> runs;              // new runs of all edit areas, one after another
  std::vector<Run> whole;             // new runs of all edit areas, with the kept runs between them
  std::vector<EditArea> areas;        // of write_changes(); apply_stack() uses those of its result
  std::vector<std::uint64_t> active;  // the active set: bit i is part i of `stack`
  std::vector<std::uint32_t> starting;  // chains of parts by the layer where they begin
  std::vector<std::uint32_t> ending;    // chains of parts by the layer where they end
  std::vector<LineEntry> entries;       // of the current layer
  LayerPlan plan;                       // of the layer painter
  LayerCanvas canvas, canvas_before;
  std::vector<std::uint32_t> program;  // parts to be evaluated over a stretch, bottom first
  MaterialFactors factors;
};

}  // namespace runstone
