// ChangeQueue: gathers what changed in a replica until it is drained. It has one entry per changed
// chunk, one per confirmed edit, and one per prediction. One thread.
#pragma once
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "client/replica/replica_changes.hpp"
#include "client/replica/tracked_chunk.hpp"

namespace runstone {

class ChangeQueue {
 public:
  /// Returns the entry of a chunk. Adds it if there is none.
  ChunkChange& chunk(const ChunkKey& key);
  /// Queues that the chunk is not shown any more. Replaces earlier entries of the chunk.
  void removed(const ChunkKey& key);
  /// Returns the entry of a confirmed edit. Adds it if there is none. The reference holds until
  /// drain().
  EditChange& edit(const OrderedInfo& info, TimeUs applied_us);
  /// Adds an entry for the prediction of a local edit. The reference holds until drain().
  EditChange& prediction(const OperationId& op, TimeUs applied_us);
  void unavailable(UnavailableChunk change) { unavailable_.push_back(change); }
  void reject(RejectedEdit change) { rejects_.push_back(std::move(change)); }
  void durable(std::span<const ClientSequence> seqs) {
    durable_.insert(durable_.end(), seqs.begin(), seqs.end());
  }
  void unseen(std::span<const ClientSequence> seqs) {
    unseen_.insert(unseen_.end(), seqs.begin(), seqs.end());
  }

  /// Notes, on both sides, that the change of the chunk contains these edits.
  static void attribute(ChunkChange& chunk, std::span<EditChange* const> edits);

  ReplicaChanges drain();

 private:
  std::map<ChunkKey, ChunkChange> chunks_;
  std::vector<std::unique_ptr<EditChange>> edits_;
  std::map<OperationId, EditChange*> confirmed_;  // entries of edits_ that are not predictions
  std::vector<RejectedEdit> rejects_;
  std::vector<UnavailableChunk> unavailable_;
  std::vector<ClientSequence> durable_, unseen_;
};

}  // namespace runstone
