// The object behind runstone_chunk: runs that are always valid, and what meshes need to know of their
// past.
#pragma once
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "bindings/c/handle.hpp"
#include "common/core/digest.hpp"
#include "common/runs/dirty_layers.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::c_interface {

/// Returns a number that no other state of a chunk in this process has; never 0. Thread: any.
std::uint64_t new_revision();

/// The layers that one call of runstone_chunk_apply() changed.
struct PastChange {
  std::uint64_t before = 0;  // the revision of the chunk before it
  DirtyLayers layers;
};

}  // namespace runstone::c_interface

struct runstone_chunk : runstone::c_interface::Handle<0x6b6e6863> {
  explicit runstone_chunk(runstone::RunChunk chunk) : runs(std::move(chunk)) {}

  /// Returns the layers that changed since a revision, or nullopt if that is not known: the chunk was
  /// never in that state, or too long ago.
  std::optional<runstone::DirtyLayers> changes_since(std::uint64_t before) const;
  /// Gives the chunk a new revision after an edit that changed these layers.
  void note_change(const runstone::DirtyLayers& layers);
  /// Gives the chunk a new revision without a past, after a change of another kind.
  void forget_past();

  runstone::RunChunk runs;
  std::optional<runstone::Digest> digest;  // of the runs, if it was needed before
  std::uint64_t revision = runstone::c_interface::new_revision();
  std::vector<runstone::c_interface::PastChange> past;  // the last ones, in order
  // Memory ran out while the runs were changed, so they may be broken.
  bool is_damaged = false;
};

namespace runstone::c_interface {

/// Returns the object of a chunk. Refuses what live() refuses, and a damaged chunk.
template <class Object>
Object& whole(Object* chunk, const char* name) {
  live(chunk, name);
  if (chunk->is_damaged)
    refuse(RUNSTONE_DAMAGED, name, "was being changed when memory ran out, and can only be freed");
  return *chunk;
}

/// Does `work`, which changes the runs. The chunk is damaged if it throws.
template <class F>
void change_runs(runstone_chunk& chunk, F&& work) {
  chunk.is_damaged = true;
  work();
  chunk.is_damaged = false;
}

/// Refuses an axis order of no chunk.
inline AxisOrder order_of(std::uint32_t order) {
  check_at_most(order, std::uint32_t{kAxisOrderCount - 1}, "order", "is no axis order");
  return static_cast<AxisOrder>(order);
}

/// Refuses an edge that chunks of a world cannot have.
inline std::int32_t edge_of(std::uint32_t edge) {
  if (edge != 16 && edge != 32 && edge != 64 && edge != 128)
    refuse(RUNSTONE_BAD_ARGUMENT, "edge", "is not 16, 32, 64 or 128");
  return static_cast<std::int32_t>(edge);
}

/// Refuses a place whose chunk would reach out of the world.
ChunkCoord place_of(runstone_pos at, std::int32_t edge);

}  // namespace runstone::c_interface
