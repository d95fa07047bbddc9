// The strategies of apply_stack(), for tests and benchmarks. All give the same chunk, digest and
// result.
#pragma once
#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/apply/run_patch.hpp"

namespace runstone {

/// The ways to find the changes.
enum class ChangeSearch : std::uint8_t {
  // Walks the runs span by span. Requires that at most one edit of the stack touches the chunk.
  // apply_stack() uses it for all such stacks; a single paste it walks without a stack
  // (walk_paste()).
  walk,
  // Sweeps run by run (edit_sweep.hpp). It takes any stack. apply_stack() uses it for several edits
  // if some of them cover whole layers.
  sweep,
  // Draws layer by layer (layer_painter.hpp). It takes any stack. apply_stack() uses it for all
  // other stacks.
  paint,
};

struct ApplyStrategy {
  ChangeSearch search = ChangeSearch::sweep;
  PatchWrite write = PatchWrite::whole;
};

/// Calls apply_stack() with a given strategy. ChangeSearch::walk requires at most one edit that
/// touches the chunk.
ApplyResult apply_stack_by(ApplyStrategy strategy, RunChunk& chunk, Digest& digest, VoxelPos origin,
                           std::span<const EditDescriptor> edits, ApplyScratch& scratch);

}  // namespace runstone
