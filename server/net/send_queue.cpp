#include "server/net/send_queue.hpp"

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone {

std::size_t SendQueue::limit(FrameClass c) const {
  switch (c) {
    case FrameClass::control:
      return limits_.control_bytes;
    case FrameClass::edits:
      return limits_.edit_bytes;
    case FrameClass::chunks:
      return limits_.chunk_bytes;
  }
  return 0;
}

bool SendQueue::push(const EncodedMessage& message) {
  Lane& mine = lane(message.frame_class);
  const std::size_t size = message.bytes->size();
  // Many small answers (chunk_unavailable) take places, too, or a peer could have millions of them queued.
  const bool has_place = message.frame_class != FrameClass::chunks || mine.items.size() < limits_.chunk_count;
  if (!has_place || (!mine.items.empty() && mine.bytes + size > limit(message.frame_class))) {
    refused_ = true;
    return false;
  }
  mine.items.push_back({message.bytes, 0});
  mine.bytes += size;
  return true;
}

std::optional<ChunkPlace> SendQueue::reserve_chunk() {
  Lane& mine = lane(FrameClass::chunks);
  if (mine.items.size() >= limits_.chunk_count || mine.bytes >= limits_.chunk_bytes) {
    refused_ = true;
    return std::nullopt;
  }
  mine.items.push_back({nullptr, next_place_});
  return next_place_++;
}

void SendQueue::fill(ChunkPlace place, const EncodedMessage& message) {
  RUNSTONE_ASSERT(message.frame_class == FrameClass::chunks);
  Lane& mine = lane(FrameClass::chunks);
  const auto found = std::find_if(mine.items.begin(), mine.items.end(),
                                  [&](const Item& item) { return item.place == place; });
  if (found == mine.items.end()) return;
  found->bytes = message.bytes;
  mine.bytes += message.bytes->size();
}

bool SendQueue::cut(FrameClass frame_class, Batch& batch) {
  Lane& mine = lane(frame_class);
  if (mine.items.empty() || mine.items.front().bytes == nullptr) return false;
  const std::shared_ptr<const Bytes>& bytes = mine.items.front().bytes;
  const std::size_t count = std::min(kFragmentBytesMax, bytes->size() - mine.sent);
  const ByteView body = ByteView(*bytes).subspan(mine.sent, count);
  const bool more = mine.sent + count < bytes->size();
  batch.pieces.push_back({frames_.next(frame_class, count, more), body});
  batch.messages.push_back(bytes);
  batch.bytes += kFrameHeaderBytes + count;
  batch.has_edits = batch.has_edits || frame_class == FrameClass::edits;
  mine.bytes -= count;
  mine.sent += count;
  if (!more) {
    mine.items.pop_front();
    mine.sent = 0;
  }
  return true;
}

bool SendQueue::take(Batch& batch) {
  batch.messages.clear();
  batch.pieces.clear();
  batch.bytes = 0;
  batch.has_edits = false;
  while (batch.bytes < limits_.write_bytes) {
    if (cut(FrameClass::edits, batch) || cut(FrameClass::control, batch)) continue;
    cut(FrameClass::chunks, batch);
    break;  // terrain in the kernel's buffer delays the next edit: one fragment per write is enough
  }
  return !batch.pieces.empty();
}

void SendQueue::drop_chunks() {
  Lane& mine = lane(FrameClass::chunks);
  mine.items.clear();
  mine.bytes = 0;
  mine.sent = 0;
}

bool SendQueue::empty() const {
  return std::all_of(lanes_.begin(), lanes_.end(), [](const Lane& l) { return l.items.empty(); });
}

bool SendQueue::take_drained() {
  if (!refused_) return false;
  for (const FrameClass c : {FrameClass::control, FrameClass::edits, FrameClass::chunks}) {
    if (lane(c).bytes > limit(c) / 2) return false;
  }
  if (lane(FrameClass::chunks).items.size() > limits_.chunk_count / 2) return false;
  refused_ = false;
  return true;
}

}  // namespace runstone
