#include "server/net/send_queue.hpp"

#include <algorithm>

#include "common/core/assert.hpp"
#include "protocol/codec/message_table.hpp"
#include "protocol/codec/view_tiles.hpp"

namespace runstone {

std::size_t SendQueue::limit(FrameClass c) const {
  switch (c) {
    case FrameClass::control:
      return limits_.control_bytes;
    case FrameClass::edits:
      return limits_.edit_bytes;
    case FrameClass::chunks:
      return chunk_bytes_max();
  }
  return 0;
}

std::size_t SendQueue::count_limit(FrameClass c) const {
  switch (c) {
    case FrameClass::control:
      return limits_.control_count;
    case FrameClass::edits:
      return limits_.edit_count;
    case FrameClass::chunks:
      return limits_.chunk_count;
  }
  return 0;
}

bool SendQueue::push(const EncodedMessage& message) {
  const FrameClass frame_class = class_of(message);
  Lane& mine = lane(frame_class);
  const std::size_t size = message.bytes->size();
  const bool has_place = mine.items.size() < count_limit(frame_class);
  if (!has_place || (!mine.items.empty() && mine.bytes + size > limit(frame_class))) {
    refused_ = true;
    return false;
  }
  mine.items.push_back({message, 0, {}, 0});
  mine.bytes += size;
  return true;
}

std::optional<ChunkPlace> SendQueue::reserve_chunk(const ChunkKey& key, std::uint32_t view) {
  Lane& mine = lane(FrameClass::chunks);
  if (mine.items.size() >= limits_.chunk_count || mine.bytes >= chunk_bytes_max()) {
    refused_ = true;
    return std::nullopt;
  }
  mine.items.push_back({{}, next_place_, {key, nullptr, 0}, view});
  return next_place_++;
}

void SendQueue::fill(ChunkPlace place, const ChunkEntry& chunk) {
  Lane& mine = lane(FrameClass::chunks);
  const auto found = std::find_if(mine.items.begin(), mine.items.end(), [&](const Item& item) {
    return item.is_place() && item.place == place;
  });
  if (found == mine.items.end()) return;
  RUNSTONE_ASSERT(found->chunk.key == chunk.key && !found->is_ready());
  found->chunk = chunk;
  mine.bytes += chunk.bytes->size();
}

void SendQueue::join_chunks() {
  Lane& mine = lane(FrameClass::chunks);
  const std::uint32_t view = mine.items.front().view;
  ChunksBuilder chunks;
  while (!mine.items.empty()) {
    Item& item = mine.items.front();
    if (!item.is_place() || !item.is_ready() || item.view != view || !chunks.fits(item.chunk))
      break;
    mine.bytes -= item.chunk.bytes->size();
    chunks.add(std::move(item.chunk));
    mine.items.pop_front();
  }
  mine.items.push_front({chunks.take(view), 0, {}, 0});
  mine.bytes += mine.items.front().message.bytes->size();
}

bool SendQueue::cut(FrameClass frame_class, std::size_t body_max, Batch& batch) {
  if (!can_cut(frame_class)) return false;
  Lane& mine = lane(frame_class);
  if (mine.items.front().is_place()) join_chunks();
  const EncodedMessage& message = mine.items.front().message;
  const std::size_t count = std::min(body_max, message.bytes->size() - mine.sent);
  const ByteView body = ByteView(*message.bytes).subspan(mine.sent, count);
  const bool more = mine.sent + count < message.bytes->size();
  batch.pieces.push_back({frames_.next(message.kind, count, more), body});
  batch.messages.push_back(message.bytes);
  batch.bytes += kFrameHeaderBytes + count;
  batch.has_commits = batch.has_commits || message.kind == kKindOf<Commit>;
  if (frame_class == FrameClass::chunks) batch.chunk_bytes += kFrameHeaderBytes + count;
  if (frame_class == FrameClass::edits) batch.edit_bytes += kFrameHeaderBytes + count;
  mine.bytes -= count;
  mine.sent += count;
  if (!more) {
    mine.items.pop_front();
    mine.sent = 0;
  }
  for (const FrameClass other : {FrameClass::control, FrameClass::chunks}) {
    lane(other).passed = other != frame_class && can_cut(other) ? lane(other).passed + count : 0;
  }
  return true;
}

bool SendQueue::take(Batch& batch, std::size_t chunk_body_max) {
  batch.messages.clear();
  batch.pieces.clear();
  batch.bytes = 0;
  batch.has_commits = false;
  batch.chunk_bytes = batch.edit_bytes = 0;
  while (batch.bytes < limits_.write_bytes) {
    const bool is_chunks_turn =
        chunk_body_max > 0 && lane(FrameClass::chunks).passed >= kPassedFragments * chunk_body_max;
    const bool is_controls_turn =
        lane(FrameClass::control).passed >= kPassedFragments * kFragmentBytesMax;
    if (is_chunks_turn && cut(FrameClass::chunks, chunk_body_max, batch)) break;
    if (is_controls_turn && cut(FrameClass::control, kFragmentBytesMax, batch)) continue;
    if (cut(FrameClass::edits, kFragmentBytesMax, batch)) continue;
    if (cut(FrameClass::control, kFragmentBytesMax, batch)) continue;
    if (chunk_body_max > 0) cut(FrameClass::chunks, chunk_body_max, batch);
    // Terrain in the kernel's buffer delays the next edit, so a write has one fragment of it at
    // most.
    break;
  }
  return !batch.pieces.empty();
}

void SendQueue::forget_outside(const View& view) {
  Lane& mine = lane(FrameClass::chunks);
  const auto goes = [&](const Item& item) {
    return item.is_place() && !contains_key(view, item.chunk.key);
  };
  for (const Item& item : mine.items) {
    if (goes(item) && item.is_ready()) mine.bytes -= item.chunk.bytes->size();
  }
  mine.items.remove_if(goes);
}

void SendQueue::drop_chunks() {
  Lane& mine = lane(FrameClass::chunks);
  mine.items.clear();
  mine.bytes = 0;
  mine.sent = 0;
  mine.passed = 0;
}

bool SendQueue::empty() const {
  return std::all_of(lanes_.begin(), lanes_.end(), [](const Lane& l) { return l.items.empty(); });
}

bool SendQueue::take_drained() {
  if (!refused_) return false;
  for (const FrameClass c : {FrameClass::control, FrameClass::edits, FrameClass::chunks}) {
    if (lane(c).bytes > limit(c) / 2 || lane(c).items.size() > count_limit(c) / 2) return false;
  }
  refused_ = false;
  return true;
}

}  // namespace runstone
