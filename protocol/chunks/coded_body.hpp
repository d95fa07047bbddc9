// CodedBody: the body of the chunk encoding `coded`. It predicts each run from the line and the
// layer before it and codes each decision as an adaptive bit. docs/protocol.md specifies the model.
// Internal to the chunk codec.
// The coder walks stretches, in which neither the run above nor the run behind changes. There are
// at most twice as many stretches as runs, so both directions cost O(runs) and visit no voxel.
// Scratch lives per thread: after the first chunks, only decoded runs are allocated.
#pragma once
#include <cstdint>
#include <span>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/runs/axis_order.hpp"
#include "common/runs/run_list.hpp"

namespace runstone {

struct CodedBody {
  std::span<const Material> palette;  // ascending
  ByteView bytes;                     // empty if there is one run
};

/// Encodes runs. The result lies in this thread's scratch and lives until the thread's next call.
/// Requires canonical runs that tile the extent. Cost: O(runs + largest id / 64).
CodedBody code_runs(const RunList& runs, OrderedExtent extent);

/// Decodes the runs of a body. They are canonical, tile the extent and use every material of the
/// palette. Offsets of errors are 0. Allocates only the runs: at most 8 bytes a voxel, and the
/// list. Requires an ascending palette of at least two ids. Cost: O(runs).
Result<RunList> decode_runs(ByteView body, std::span<const Material> palette, OrderedExtent extent);

}  // namespace runstone
