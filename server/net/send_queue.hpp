// SendQueue: what one session still has to send, bounded per class, cut into frames by priority:
// edits before control before chunks, chosen anew for every fragment. So an edit waits for one fragment of
// terrain at most, while each class keeps its own order. A class that waits is never starved: once four fragments'
// worth of others has passed it, its turn comes. A chunk may take its place in the queue before its
// bytes are made: a worker fills the place later, and nothing of its class overtakes it. Threads: none of its
// own; the session guards it with a mutex (a leaf).
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "protocol/codec/frame.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

struct SendLimits {
  std::size_t control_bytes = 16 * 1024 * 1024;  // one welcome with a full material table, and more
  std::size_t edit_bytes = 4 * 1024 * 1024;
  std::size_t chunk_bytes = 4 * 1024 * 1024;  // a chunk is taken while less is queued
  // Messages that wait: a small one costs several times its bytes of memory, and a peer may have many made that it never reads.
  std::size_t control_count = 1024;
  std::size_t edit_count = 16 * 1024;
  std::size_t chunk_count = 256;        // places taken, filled or not
  std::size_t write_bytes = 32 * 1024;  // handed to the socket at a time
};

/// Names a place taken for a chunk.
using ChunkPlace = std::uint64_t;

class SendQueue {
 public:
  explicit SendQueue(const SendLimits& limits) : limits_(limits) {}

  /// False: full, nothing was queued. A message larger than the whole bound fits an empty class.
  bool push(const EncodedMessage& message);
  /// A place at the end of the chunk class; nothing if it is full. `key`: whose snapshot will fill it.
  std::optional<ChunkPlace> reserve_chunk(const std::optional<ChunkKey>& key = std::nullopt);
  /// Fills a place. Places dropped meanwhile are ignored.
  void fill(ChunkPlace place, const EncodedMessage& message);

  /// One write: headers and pieces of bodies in the order in which they go out. Reused between writes.
  struct Batch {
    std::vector<std::shared_ptr<const Bytes>> messages;  // keeps the bodies alive
    struct Piece {
      FrameHeader header{};
      ByteView body;
    };
    std::vector<Piece> pieces;
    bool has_edits = false;
    std::size_t bytes = 0;        // headers included
    std::size_t chunk_bytes = 0;  // of them, of the class chunks
  };
  /// Takes the next fragments, about `write_bytes` and one fragment of the chunk class at most, whose body has
  /// `chunk_body_max` bytes at most (0: no chunk now); false if there are none. The batch's bytes leave the
  /// bounds at once.
  bool take(Batch& batch, std::size_t chunk_body_max = kFragmentBytesMax);
  /// Whether so much of other classes has passed the chunks that they have their turn however little room there is.
  bool are_chunks_starved() const {
    return lane(FrameClass::chunks).passed >= kPassedFragments * kFragmentBytesMax;
  }
  /// Whether the next chunk is there and could be taken.
  bool has_chunk() const { return can_cut(FrameClass::chunks); }

  /// Drops snapshots that nothing was sent of and that lie outside of the view.
  void forget_outside(const View& view);
  /// How many bytes of chunks may wait, within the limits: on a slow link fewer, so that the order in which they
  /// are wanted now counts soon.
  void set_chunk_backlog(std::size_t bytes) { chunk_backlog_ = bytes; }
  /// Chunks are not worth sending any more: the session closes. Drops them, also those still to be filled.
  void drop_chunks();
  bool empty() const;
  std::size_t queued_bytes(FrameClass frame_class) const { return lane(frame_class).bytes; }

  /// After a refusal: whether there is room again in all classes. Tells each refusal once.
  bool take_drained();

 private:
  struct Item {
    std::shared_ptr<const Bytes> bytes;  // null: a place not filled yet
    ChunkPlace place = 0;
    std::optional<ChunkKey> key;
  };
  struct Lane {
    std::deque<Item> items;
    std::size_t sent = 0;    // bytes of the first item already cut
    std::size_t bytes = 0;   // queued, without what was cut
    std::size_t passed = 0;  // bytes of other classes that went while this one could have
  };
  Lane& lane(FrameClass c) { return lanes_[static_cast<std::size_t>(c)]; }
  const Lane& lane(FrameClass c) const { return lanes_[static_cast<std::size_t>(c)]; }
  std::size_t limit(FrameClass c) const;
  std::size_t count_limit(FrameClass c) const;
  bool can_cut(FrameClass frame_class) const {
    const Lane& mine = lane(frame_class);
    return !mine.items.empty() && mine.items.front().bytes != nullptr;
  }
  bool cut(FrameClass frame_class, std::size_t body_max, Batch& batch);

  static constexpr std::size_t kPassedFragments = 4;

  std::size_t chunk_bytes_max() const { return std::min(limits_.chunk_bytes, chunk_backlog_); }

  SendLimits limits_;
  std::size_t chunk_backlog_ = SIZE_MAX;
  std::array<Lane, kFrameClassCount> lanes_;
  FrameWriter frames_;
  ChunkPlace next_place_ = 1;
  bool refused_ = false;
};

}  // namespace runstone
