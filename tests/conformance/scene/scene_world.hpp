// SceneWorld: the world of a scene. It orders edits as the real server does, with the same function
// that applies them, and has no sessions, no disk and no clock.
#pragma once
#include <map>
#include <set>

#include "common/edits/apply/apply_scratch.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/chunk.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone::conformance {

class SceneWorld {
 public:
  static constexpr std::int32_t kEdge = 16;
  /// The materials 1 to 6 are solid cubes.
  static constexpr Material kStone = 1, kEarth = 2, kMoss = 3, kBrick = 4, kGlass = 5, kLamp = 6;

  static MaterialTable materials();

  Epoch epoch() const { return epoch_; }
  Sequence head() const { return head_; }
  /// Returns a chunk. Before the first edit it is ground below y = 16, and air above.
  const Chunk& chunk(ChunkCoord at);
  ChunkSnapshot snapshot(ChunkCoord at) { return {{0, at}, chunk(at)}; }
  /// Gives the edit the next sequence and applies it.
  OrderedEdit order(const OperationId& op, const EditDescriptor& edit);
  /// Returns a commit of one edit.
  Commit commit_of(const OrderedEdit& edit) const { return {epoch_, {edit}}; }
  /// Forgets all edits and raises the epoch, as after a crash before anything was durable.
  void restart();

  /// The chunks that the server cannot send.
  std::set<ChunkCoord> damaged;

 private:
  Epoch epoch_ = 7;
  Sequence head_ = 0;
  std::map<ChunkCoord, Chunk> chunks_;
  ApplyScratch scratch_;
};

}  // namespace runstone::conformance
