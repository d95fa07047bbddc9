// CodedBody: the body of the `coded` chunk encoding: runs by what the line and the layer before them do, each
// decision an adaptive bit. docs/protocol.md has the model. Internal to the chunk codec.
// It walks stretches, in which neither the run above nor the run behind changes; their number is at most twice
// that of the runs, so both directions are O(runs) and see no voxel.
// Scratch lives per thread: a steady state allocates nothing but the runs that are decoded.
#pragma once
#include <cstdint>
#include <span>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/runs/axis_order.hpp"
#include "common/runs/run_list.hpp"

namespace runstone {

struct CodedBody {
  std::span<const Material>
      palette;     // ascending; of this thread's scratch, until its next code_runs()
  ByteView bytes;  // likewise; empty if there is one run
};

/// Requires canonical runs that tile the extent. O(runs + largest id / 64).
CodedBody code_runs(const RunList& runs, OrderedExtent extent);

/// Runs of a body. Requires an ascending palette of at least two ids. The runs are canonical, tile the extent
/// and use the palette up. Offsets of errors are 0. Takes memory for the runs only: at most 8 bytes a voxel and
/// the list. O(runs).
Result<RunList> decode_runs(ByteView body, std::span<const Material> palette, OrderedExtent extent);

}  // namespace runstone
