#include "client/replica/change_queue.hpp"

#include <algorithm>

namespace runstone {

ChunkChange& ChangeQueue::chunk(const ChunkKey& key) {
  ChunkChange& change = chunks_[key];
  change.key = key;
  return change;
}

void ChangeQueue::removed(const ChunkKey& key) {
  ChunkChange& change = chunk(key);
  change = {};
  change.key = key;
  change.removed = true;
}

EditChange& ChangeQueue::edit(const OrderedInfo& info, TimeUs applied_us) {
  EditChange*& slot = confirmed_[info.op];
  if (slot == nullptr) {
    auto change = std::make_unique<EditChange>();
    change->op = info.op;
    change->seq = info.version.seq;
    change->subject = info.subject;
    change->is_local = info.is_local;
    change->submitted_us = info.submitted_us;
    change->ordered_us = info.ordered_us;
    change->received_us = info.received_us;
    change->unpacked_us = info.unpacked_us;
    change->applied_us = applied_us;
    slot = change.get();
    edits_.push_back(std::move(change));
  }
  return *slot;
}

EditChange& ChangeQueue::prediction(const OperationId& op, TimeUs applied_us) {
  auto change = std::make_unique<EditChange>();
  change->op = op;
  change->is_local = true;
  change->predicted = true;
  change->received_us = change->unpacked_us = change->applied_us = applied_us;
  return *edits_.emplace_back(std::move(change));
}

void ChangeQueue::attribute(ChunkChange& chunk, std::span<EditChange* const> edits) {
  for (EditChange* edit : edits) {
    if (std::find(edit->chunks.begin(), edit->chunks.end(), chunk.key) == edit->chunks.end()) {
      edit->chunks.push_back(chunk.key);
    }
    if (chunk.edits.empty() || chunk.edits.back() != edit->op) chunk.edits.push_back(edit->op);
    chunk.has_local_edit = chunk.has_local_edit || edit->is_local;
  }
}

ReplicaChanges ChangeQueue::drain() {
  ReplicaChanges changes;
  changes.chunks.reserve(chunks_.size());
  for (auto& [key, chunk] : chunks_) changes.chunks.push_back(std::move(chunk));
  changes.edits.reserve(edits_.size());
  for (auto& edit : edits_) changes.edits.push_back(std::move(*edit));
  changes.rejects = std::exchange(rejects_, {});
  changes.durable = std::exchange(durable_, {});
  changes.unseen = std::exchange(unseen_, {});
  changes.unavailable = std::exchange(unavailable_, {});
  chunks_.clear();
  edits_.clear();
  confirmed_.clear();
  return changes;
}

}  // namespace runstone
