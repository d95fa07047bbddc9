// SendQueue: what one session still has to send, bounded per class, cut into frames by priority:
// edits before control before chunks, chosen anew for every fragment. So an edit waits for one fragment of
// terrain at most, while each class keeps its own order. A chunk may take its place in the queue before its
// bytes are made: a worker fills the place later, and nothing of its class overtakes it. Threads: none of its
// own; the session guards it with a mutex (a leaf).
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "protocol/codec/frame.hpp"

namespace runstone {

struct SendLimits {
  std::size_t control_bytes = 16 * 1024 * 1024;  // one welcome with a full material table, and more
  std::size_t edit_bytes = 4 * 1024 * 1024;
  std::size_t chunk_bytes = 4 * 1024 * 1024;  // a chunk is taken while less is queued
  std::size_t chunk_count = 64;               // places taken, filled or not
  std::size_t write_bytes = 32 * 1024;        // handed to the socket at a time
};

/// Names a place taken for a chunk.
using ChunkPlace = std::uint64_t;

class SendQueue {
 public:
  explicit SendQueue(const SendLimits& limits) : limits_(limits) {}

  /// False: full, nothing was queued. A message larger than the whole bound fits an empty class.
  bool push(const EncodedMessage& message);
  /// A place at the end of the chunk class; nothing if it is full.
  std::optional<ChunkPlace> reserve_chunk();
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
    std::size_t bytes = 0;
    bool has_edits = false;
  };
  /// Takes the next fragments, about `write_bytes` and one fragment of the chunk class at most; false if
  /// there are none. The batch's bytes leave the bounds at once.
  bool take(Batch& batch);

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
  };
  struct Lane {
    std::deque<Item> items;
    std::size_t sent = 0;   // bytes of the first item already cut
    std::size_t bytes = 0;  // queued, without what was cut
  };
  Lane& lane(FrameClass c) { return lanes_[static_cast<std::size_t>(c)]; }
  const Lane& lane(FrameClass c) const { return lanes_[static_cast<std::size_t>(c)]; }
  std::size_t limit(FrameClass c) const;
  bool cut(FrameClass frame_class, Batch& batch);

  SendLimits limits_;
  std::array<Lane, kFrameClassCount> lanes_;
  FrameWriter frames_;
  ChunkPlace next_place_ = 1;
  bool refused_ = false;
};

}  // namespace runstone
