// AuthorityModel: the smallest world that orders edits, without sessions, queues or disk. It is the
// oracle of replica tests: it keeps voxels through apply_stack() one edit at a time, and versions
// by a rule of its own.
#pragma once
#include <map>
#include <utility>
#include <vector>

#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/runs/chunk.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone::test {

class AuthorityModel {
 public:
  explicit AuthorityModel(std::int32_t edge = 16, Epoch epoch = 1) : edge_(edge), epoch_(epoch) {}

  Epoch epoch() const { return epoch_; }
  Sequence head() const { return head_; }

  /// Returns a chunk. Before the first edit it is stone (material 1) below y = 0 and air above.
  const Chunk& chunk(ChunkCoord at) {
    const auto it = chunks_.find(at);
    if (it != chunks_.end()) return it->second;
    Chunk fresh;
    fresh.voxels =
        uniform_chunk(Extent::cube(static_cast<unsigned>(edge_)), at.y < 0 ? Material{1} : kEmpty);
    fresh.digest = digest_of(fresh.voxels);
    return chunks_.emplace(at, std::move(fresh)).first->second;
  }

  /// Replaces a chunk. Requires that no edit touched it.
  void put(ChunkCoord at, RunChunk voxels) {
    Chunk placed;
    placed.digest = digest_of(voxels);
    placed.voxels = std::move(voxels);
    chunks_.insert_or_assign(at, std::move(placed));
  }

  ChunkSnapshot snapshot(ChunkCoord at) { return {{0, at}, chunk(at)}; }

  /// Assigns the next sequence numbers to the edits and applies them.
  Commit commit(const std::vector<std::pair<OperationId, EditDescriptor>>& edits,
                TimeUs now_us = 0) {
    Commit out;
    out.epoch = epoch_;
    for (const auto& [op, edit] : edits) {
      ++head_;
      OrderedEdit ordered;
      ordered.seq = head_;
      ordered.op = op;
      ordered.submitted_us = ordered.ordered_us = now_us;
      ordered.edit = edit;
      for (const ChunkCoord at : touched_chunks(edit, edge_)) {
        static_cast<void>(chunk(at));
        Chunk& target = chunks_.find(at)->second;
        ordered.previous.push_back(target.version.seq);
        apply_stack(target.voxels, target.digest, origin_of(at, edge_), {&edit, 1}, scratch_);
        target.version = {epoch_, head_};
      }
      out.edits.push_back(std::move(ordered));
    }
    return out;
  }
  Commit commit(const OperationId& op, const EditDescriptor& edit, TimeUs now_us = 0) {
    return commit({{op, edit}}, now_us);
  }

  /// Simulates a crash and a new start: edits after `durable` are lost. `replay` holds the edits 1
  /// .. durable.
  void restart(const std::vector<std::pair<OperationId, EditDescriptor>>& replay) {
    chunks_.clear();
    head_ = 0;
    static_cast<void>(commit(replay));
    ++epoch_;
  }

  /// Replaces a material by air in a chunk that is to be sent.
  static void hollow(Chunk& chunk, Material material) {
    for (VoxelIndex i = 0; i < chunk.voxels.volume(); ++i) {
      if (chunk.voxels.runs.material(find_run(chunk.voxels, i)) == material)
        fill(chunk.voxels, i, 1, kEmpty);
    }
    chunk.digest = digest_of(chunk.voxels);
  }

 private:
  std::int32_t edge_;
  Epoch epoch_;
  Sequence head_ = 0;
  std::map<ChunkCoord, Chunk> chunks_;
  ApplyScratch scratch_;
};

}  // namespace runstone::test
