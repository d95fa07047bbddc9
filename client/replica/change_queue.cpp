#include "client/replica/change_queue.hpp"

#include <algorithm>
#include <utility>

namespace runstone {

ChunkNews& ChangeQueue::chunk(const ChunkKey& key) {
  ChunkNews& news = chunks_[key];
  news.key = key;
  return news;
}

void ChangeQueue::removed(const ChunkKey& key) {
  ChunkNews& news = chunk(key);
  news = {};
  news.key = key;
  news.removed = true;
}

EditNews& ChangeQueue::edit(const OrderedInfo& info, TimeUs applied_us) {
  EditNews*& slot = confirmed_[info.op];
  if (slot == nullptr) {
    auto news = std::make_unique<EditNews>();
    news->op = info.op;
    news->seq = info.version.seq;
    news->subject = info.subject;
    news->own = info.own;
    news->submitted_us = info.submitted_us;
    news->ordered_us = info.ordered_us;
    news->received_us = info.received_us;
    news->unpacked_us = info.unpacked_us;
    news->applied_us = applied_us;
    slot = news.get();
    edits_.push_back(std::move(news));
  }
  return *slot;
}

EditNews& ChangeQueue::prediction(const OperationId& op, TimeUs applied_us) {
  auto news = std::make_unique<EditNews>();
  news->op = op;
  news->own = true;
  news->predicted = true;
  news->received_us = news->unpacked_us = news->applied_us = applied_us;
  return *edits_.emplace_back(std::move(news));
}

void ChangeQueue::attribute(ChunkNews& chunk, std::span<EditNews* const> edits) {
  for (EditNews* edit : edits) {
    if (std::find(edit->chunks.begin(), edit->chunks.end(), chunk.key) == edit->chunks.end()) {
      edit->chunks.push_back(chunk.key);
    }
    if (chunk.edits.empty() || chunk.edits.back() != edit->op) chunk.edits.push_back(edit->op);
  }
}

ReplicaChanges ChangeQueue::take() {
  ReplicaChanges news;
  news.chunks.reserve(chunks_.size());
  for (auto& [key, chunk] : chunks_) news.chunks.push_back(std::move(chunk));
  news.edits.reserve(edits_.size());
  for (auto& edit : edits_) news.edits.push_back(std::move(*edit));
  news.rejects = std::exchange(rejects_, {});
  news.durable = std::exchange(durable_, {});
  news.unseen = std::exchange(unseen_, {});
  news.unavailable = std::exchange(unavailable_, {});
  chunks_.clear();
  edits_.clear();
  confirmed_.clear();
  return news;
}

}  // namespace runstone
