// ChangeQueue: gathers what changed in a replica until it is taken: one entry per chunk, one per edit and way.
// One thread.
#pragma once
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "client/replica/replica_changes.hpp"
#include "client/replica/tracked_chunk.hpp"

namespace runstone {

class ChangeQueue {
 public:
  /// The entry of a chunk, made if there is none.
  ChunkNews& chunk(const ChunkKey& key);
  /// Nothing of this chunk is shown any more; what was noted of it before is void.
  void removed(const ChunkKey& key);
  /// The entry of an edit in the confirmed order, made if there is none. Entries stay where they are until
  /// take().
  EditNews& edit(const OrderedInfo& info, TimeUs applied_us);
  /// A new entry for the prediction of an own edit.
  EditNews& prediction(const OperationId& op, TimeUs applied_us);
  void unavailable(UnavailableNews news) { unavailable_.push_back(news); }
  void reject(RejectNews news) { rejects_.push_back(std::move(news)); }
  void durable(std::span<const ClientSequence> seqs) {
    durable_.insert(durable_.end(), seqs.begin(), seqs.end());
  }
  void unseen(std::span<const ClientSequence> seqs) {
    unseen_.insert(unseen_.end(), seqs.begin(), seqs.end());
  }

  /// Says that these edits are contained in what changed of the chunk.
  static void attribute(ChunkNews& chunk, std::span<EditNews* const> edits);

  ReplicaChanges take();

 private:
  std::map<ChunkKey, ChunkNews> chunks_;
  std::vector<std::unique_ptr<EditNews>> edits_;
  std::map<OperationId, EditNews*> confirmed_;  // those of edits_ that are not predictions
  std::vector<RejectNews> rejects_;
  std::vector<UnavailableNews> unavailable_;
  std::vector<ClientSequence> durable_, unseen_;
};

}  // namespace runstone
