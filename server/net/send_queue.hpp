// SendQueue: the messages that a session still has to send, bounded for each class and cut into
// fragments. For each fragment it chooses the class by priority: edits, then control, then chunks.
// So an edit waits for at most one fragment of terrain, and each class keeps its own order. No
// class is starved: when kPassedFragments fragments of other classes have passed a class, its next
// fragment is sent. A chunk reserves a place in the queue before a worker has encoded it, and later
// messages of its class wait for it. Chunks that wait next to each other are joined to one message
// when their turn comes: the slower the link, the fewer envelopes it carries.
// Threads: one; the session guards it with a mutex (a leaf).
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "protocol/codec/chunk_entries.hpp"
#include "protocol/codec/frame.hpp"
#include "protocol/codec/messages.hpp"
#include "server/net/flat_queue.hpp"

namespace runstone {

struct SendLimits {
  std::size_t control_bytes = 16 * 1024 * 1024;  // more than a welcome with a full material table
  std::size_t edit_bytes = 4 * 1024 * 1024;
  std::size_t chunk_bytes = 4 * 1024 * 1024;  // a chunk is accepted while less is queued
  // Messages. A small message needs several times its bytes of memory, and a client that does not
  // read could cause many of them.
  std::size_t control_count = 1024;
  std::size_t edit_count = 16 * 1024;
  std::size_t chunk_count = 256;        // reserved places, filled or not
  std::size_t write_bytes = 32 * 1024;  // handed to the socket at a time
};

/// Identifies the reserved place of a chunk. 0 is no place.
using ChunkPlace = std::uint64_t;

class SendQueue {
 public:
  explicit SendQueue(const SendLimits& limits) : limits_(limits) {}
  /// Replaces the limits. What is queued stays.
  void set_limits(const SendLimits& limits) { limits_ = limits; }

  /// Queues a message. Returns false if its class is full. An empty class accepts a message of any
  /// size.
  bool push(const EncodedMessage& message);
  /// Reserves a place at the end of the chunk class for this chunk, as an answer to the view of
  /// this number. Returns nullopt if the class is full.
  std::optional<ChunkPlace> reserve_chunk(const ChunkKey& key, std::uint32_t view);
  /// Fills a place with its chunk. Does nothing if the place was dropped.
  void fill(ChunkPlace place, const ChunkEntry& chunk);

  /// One write: headers and pieces of bodies in the order of sending. It is reused between writes.
  struct Batch {
    std::vector<std::shared_ptr<const Bytes>> messages;  // keeps the bodies alive
    struct Piece {
      FrameHeader header{};
      ByteView body;
    };
    std::vector<Piece> pieces;
    bool has_commits = false;  // or parts of them
    std::size_t bytes = 0;     // headers included
    // The parts of `bytes` that are of the classes chunks and edits.
    std::size_t chunk_bytes = 0, edit_bytes = 0;
  };
  /// Takes the next fragments: about `write_bytes`, with at most one fragment of the chunk class,
  /// whose body has at most `chunk_body_max` bytes (0: none). Returns false if there are none. The
  /// bytes do not count for the bounds any more.
  bool take(Batch& batch, std::size_t chunk_body_max = kFragmentBytesMax);
  /// Returns true if so many bytes of other classes have passed the chunks that the next chunk
  /// fragment must be sent, whatever the room.
  bool are_chunks_starved() const {
    return lane(FrameClass::chunks).passed >= kPassedFragments * kFragmentBytesMax;
  }
  /// Returns true if the next chunk is filled, so that a fragment of it can be taken.
  bool has_chunk() const { return can_cut(FrameClass::chunks); }

  /// Returns true if take() without chunks would take something.
  bool can_take() const { return can_cut(FrameClass::edits) || can_cut(FrameClass::control); }

  /// Drops chunks outside of the view of which nothing was sent.
  void forget_outside(const View& view);
  /// Sets how many bytes of chunks may wait, within the limits. On a slow link this is less, so
  /// that a new view changes the order of chunks soon.
  void set_chunk_backlog(std::size_t bytes) { chunk_backlog_ = bytes; }
  /// Drops all chunks and reserved places, because the session closes.
  void drop_chunks();
  bool empty() const;
  std::size_t queued_bytes(FrameClass frame_class) const { return lane(frame_class).bytes; }

  /// Returns true once after a class was full, when all classes have room again.
  bool take_drained();

 private:
  /// A message, or the place of a chunk.
  struct Item {
    EncodedMessage message;  // without bytes: a place
    ChunkPlace place = 0;
    ChunkEntry chunk;        // of a place; without bytes until it is filled
    std::uint32_t view = 0;  // of a place
    bool is_place() const { return message.bytes == nullptr; }
    bool is_ready() const { return !is_place() || chunk.bytes != nullptr; }
  };
  struct Lane {
    FlatQueue<Item> items;
    std::size_t sent = 0;   // bytes of the first item that were taken
    std::size_t bytes = 0;  // queued bytes, without those that were taken
    std::size_t passed =
        0;  // bytes of other classes that were taken while this class had a fragment
  };
  Lane& lane(FrameClass c) { return lanes_[static_cast<std::size_t>(c)]; }
  const Lane& lane(FrameClass c) const { return lanes_[static_cast<std::size_t>(c)]; }
  std::size_t limit(FrameClass c) const;
  std::size_t count_limit(FrameClass c) const;
  bool can_cut(FrameClass frame_class) const {
    const Lane& mine = lane(frame_class);
    return !mine.items.empty() && mine.items.front().is_ready();
  }
  bool cut(FrameClass frame_class, std::size_t body_max, Batch& batch);
  /// Makes one message of the first chunks, as many as are filled, answer the same view and fit.
  /// Requires that the first item is a filled chunk.
  void join_chunks();

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
