// ChunkGate: decides when a session may send its next fragment of terrain. Two things limit it: the
// link (ChunkPace if the client acknowledges what it reads, otherwise TCP), and the byte budgets of
// the session and of the server. Edits and control messages never wait here, but their bytes count.
// Times are arguments. One thread; the session guards it with its mutex.
#pragma once
#include <algorithm>
#include <cstddef>
#include <optional>

#include "server/net/byte_budget.hpp"
#include "server/net/chunk_pace.hpp"

namespace runstone {

class ChunkGate {
 public:
  /// `session_per_second`: bytes a second, 0 for no limit. `shared` must outlive the gate.
  ChunkGate(std::uint64_t session_per_second, ByteBudget& shared)
      : session_(session_per_second), shared_(shared) {}

  /// Paces terrain by the client's acknowledgements from now on.
  void pace() { is_paced_ = true; }
  bool is_paced() const { return is_paced_; }
  const ChunkPace& measured() const { return pace_; }

  /// Returns how many bytes the body of the next fragment may have now, or 0 if it must wait until
  /// next_us(). Call it only when terrain waits. `room_bytes`: how many bytes the socket takes
  /// without queueing them.
  std::size_t open(TimeUs now_us, std::size_t room_bytes = SIZE_MAX) {
    if (room_bytes <= kFrameHeaderBytes) return 0;
    if (is_paced_ && !pace_.may_send(now_us)) return 0;
    const std::size_t bytes = std::min(is_paced_ ? pace_.fragment_bytes() : kFragmentBytesMax,
                                       room_bytes - kFrameHeaderBytes);
    if (!session_.is_limited() && !shared_.is_limited()) return bytes;
    if (credit_ >= bytes) return bytes;
    if (!slot_us_)
      slot_us_ = std::max(session_.book(kSlotBytes, now_us), shared_.book(kSlotBytes, now_us));
    if (now_us < *slot_us_) return 0;
    slot_us_.reset();
    credit_ += kSlotBytes;
    return bytes;
  }
  /// Returns when to call open() again after it returned 0, if no acknowledgement comes before.
  TimeUs next_us(TimeUs now_us) const {
    if (is_paced_ && !pace_.may_send(now_us)) return pace_.next_us(now_us);
    return std::max(now_us, slot_us_.value_or(now_us));
  }

  /// Counts bytes of frames that were handed to the socket, of chunks and of the other classes.
  void sent(std::size_t chunk_bytes, std::size_t other_bytes, TimeUs now_us) {
    if (chunk_bytes > 0 && is_paced_) pace_.sent(chunk_bytes, now_us);
    credit_ -= std::min(credit_, chunk_bytes);
    session_.charge(other_bytes, now_us);
    shared_.charge(other_bytes, now_us);
  }
  Result<void> acked(std::uint64_t total, TimeUs now_us) { return pace_.acked(total, now_us); }
  /// Returns how many bytes of chunks may be queued: what the link carries in a quarter of a
  /// second.
  std::size_t backlog_bytes() const {
    constexpr std::uint64_t kBacklogPerSecond = 4;
    return static_cast<std::size_t>(
        std::max<std::uint64_t>(kBacklogMin, pace_.rate() / kBacklogPerSecond));
  }
  /// Reports that the session has nothing to send, although the link has room.
  void mark_app_limited() { pace_.mark_app_limited(); }

 private:
  static constexpr std::size_t kBacklogMin = 64 * 1024;
  static constexpr std::size_t kSlotBytes = kFrameHeaderBytes + kFragmentBytesMax;

  ChunkPace pace_;
  bool is_paced_ = false;
  ByteBudget session_;
  ByteBudget& shared_;
  std::size_t credit_ = 0;         // bytes of slots that have begun
  std::optional<TimeUs> slot_us_;  // the slot that is booked
};

}  // namespace runstone
