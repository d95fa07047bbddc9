// ChunkSending: sends chunks to sessions. A session is subscribed in the same call that takes the
// snapshot's version, so every commit after the snapshot reaches the session. A client may claim
// copies of chunks that it has. A claim waits until its chunk is about to be sent, and is answered
// with less than a snapshot where that is possible. The answer is made in the call that subscribes
// the session, from the chunk's version V at that time. It is one of:
//   - "not modified", if the copy is at V;
//   - the edits that lead from the copy to V;
//   - a snapshot at V.
// From that call on, every commit behind V goes to the session, so no commit is lost, even if a
// worker chooses between edits and snapshot later.
// Thread: the world strand.
#pragma once
#include <cstdint>
#include <span>

#include "server/world/ground/ground_base.hpp"

namespace runstone {

/// Uniform chunks are sent when so many are due.
inline constexpr std::size_t kUniformPerMessage = 256;
/// Uniform chunks that may be due while the session's queue is full. Further chunks stay wanted.
inline constexpr std::size_t kUniformWaitingMax = 1024;
static_assert(kUniformWaitingMax <= kUniformChunksMax);
/// Messages of "not modified" that one task sends. Each has up to kChunksNotModifiedMax answers and
/// takes about 0.1 ms.
inline constexpr std::size_t kNotModifiedPerCall = 4;

class ChunkSending {
 public:
  explicit ChunkSending(GroundBase& base) : base_(base) {}

  /// Returns true if the session's queue was full a moment ago.
  bool is_stalled(const Viewer& viewer, const Clocks& now) const;
  /// Returns the number of the session's view in force, or 0 before the first one. Answers carry
  /// it.
  std::uint32_t view_in_force(const Viewer& viewer) const;
  /// Describes the state of the world that the session sees.
  ViewState view_state(const Viewer& viewer, ViewPhase phase) const;

  /// Queues a wanted chunk for the session and moves it to the state `then`. Sends "chunk
  /// unavailable" if `chunk` is null. Returns false if the session's queue is full; the chunk stays
  /// wanted.
  bool send_chunk(Viewer& viewer, const ChunkKey& key, const ChunkPtr& chunk, ChunkInterest then,
                  const Clocks& now);
  /// Queues a chunk of one material to be sent together with others. Returns false if too many
  /// wait.
  bool queue_uniform(Viewer& viewer, const ChunkKey& key, const Chunk& chunk, const Clocks& now);
  /// Sends the uniform chunks that are due for the session, in one message for each level of
  /// detail. Returns false if its queue is full; the chunks that are not sent stay due.
  bool send_uniform(Viewer& viewer, const Clocks& now);
  enum class AnswersSent : std::uint8_t {
    all,
    some,  // the others have a task of their own
    full,  // the session's queue is full; the rest stays due
  };
  /// Sends the "not modified" answers that are due, at most kNotModifiedPerCall messages of them.
  /// While more may follow (`is_more`), it sends only full messages.
  AnswersSent send_not_modified(Viewer& viewer, bool is_more);
  /// Sends the reports that must precede the session's next chunk. Returns false if its queue is
  /// full, or if answers that precede the reports have a task of their own.
  bool send_view_states(Viewer& viewer, const Clocks& now);
  /// Ends a delivery: sends the uniform chunks that are due unless loads under way may soon add
  /// more, and reports once that every chunk of the view was answered.
  void end_delivery(Viewer& viewer, const Clocks& now);

  /// Drops chunks that are queued for the session and lie outside of its view or will be answered
  /// anew.
  void forget_unsent(Viewer& viewer);
  /// Marks chunks as outdated for a session because a commit did not fit its queue. The session is
  /// unsubscribed from them and gets them again as snapshots when its queue has room.
  void mark_outdated(Viewer& viewer, std::span<const ChunkKey> keys, const Clocks& now);

 private:
  enum class ClaimReply : std::uint8_t {
    none,    // there is no claim, or it is of no use: send a snapshot
    queued,  // the reply is queued
    full,    // the session's queue is full
  };
  /// Replies to the session's claim of this chunk, if there is one. Requires a chunk.
  ClaimReply reply_to_claim(Viewer& viewer, const ChunkKey& key, const ChunkPtr& chunk);
  /// Leaves the chunk wanted because the session's queue is full.
  void put_off(Viewer& viewer, const ChunkKey& key, const Clocks& now);

  GroundBase& base_;
};

}  // namespace runstone
