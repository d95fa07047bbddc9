// The ways apply_stack() can take, for tests and benchmarks: all give the same chunk, digest and result.
#pragma once
#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/apply/run_patch.hpp"

namespace runstone {

/// How the changes are found.
enum class ChangeSearch : std::uint8_t {
  walk,  // span by span; for stacks of which at most one edit touches the chunk, and taken for those
  sweep,  // any stack; taken for several edits of which some cover whole layers
  paint,  // any stack; taken for all others
};

struct ApplyStrategy {
  ChangeSearch search = ChangeSearch::sweep;
  PatchWrite write = PatchWrite::whole;
};

/// apply_stack() by a given strategy. Requires at most one edit that touches the chunk for
/// ChangeSearch::walk.
ApplyResult apply_stack_by(ApplyStrategy strategy, RunChunk& chunk, Digest& digest, VoxelPos origin,
                           std::span<const EditDescriptor> edits, ApplyScratch& scratch);

}  // namespace runstone
