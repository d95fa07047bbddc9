// ChunkGate: when the next fragment of terrain of one session may go: as the link allows (ChunkPace, if the client
// tells what it has read; TCP alone otherwise), and as the budgets of the session and of the server do. Edits and
// control never wait here, but their bytes count. Times are arguments. One thread; the session guards it with its
// mutex.
#pragma once
#include <algorithm>
#include <cstddef>
#include <optional>

#include "server/net/byte_budget.hpp"
#include "server/net/chunk_pace.hpp"

namespace runstone {

class ChunkGate {
 public:
  /// `own_per_second`: bytes, 0 for no limit. `shared` must outlive the gate.
  ChunkGate(std::uint64_t own_per_second, ByteBudget& shared)
      : own_(own_per_second), shared_(shared) {}

  /// The client tells what it has read: from now on terrain is paced by that.
  void pace() { is_paced_ = true; }
  bool is_paced() const { return is_paced_; }
  const ChunkPace& measured() const { return pace_; }

  /// Something waits to be sent: the body of a fragment may have so many bytes now; 0: none, see next_us().
  /// `room_bytes`: what may be handed to the socket without waiting there.
  std::size_t open(TimeUs now_us, std::size_t room_bytes = SIZE_MAX) {
    if (room_bytes <= kFrameHeaderBytes) return 0;
    if (is_paced_ && pace_.room(now_us) == 0) return 0;
    const std::size_t bytes = std::min(is_paced_ ? pace_.fragment_bytes() : kFragmentBytesMax,
                                       room_bytes - kFrameHeaderBytes);
    if (!own_.is_limited() && !shared_.is_limited()) return bytes;
    if (credit_ >= bytes) return bytes;
    if (!turn_us_)
      turn_us_ = std::max(own_.book(kTurnBytes, now_us), shared_.book(kTurnBytes, now_us));
    if (now_us < *turn_us_) return 0;
    turn_us_.reset();
    credit_ += kTurnBytes;
    return bytes;
  }
  /// After open() said 0: when to ask again if the client says nothing before.
  TimeUs next_us(TimeUs now_us) const {
    if (is_paced_ && pace_.room(now_us) == 0) return pace_.next_us(now_us);
    return std::max(now_us, turn_us_.value_or(now_us));
  }

  /// Bytes of frames handed to the socket, of chunks and of the other classes.
  void sent(std::size_t chunk_bytes, std::size_t other_bytes, TimeUs now_us) {
    if (chunk_bytes > 0 && is_paced_) pace_.sent(chunk_bytes, now_us);
    credit_ -= std::min(credit_, chunk_bytes);
    own_.charge(other_bytes, now_us);
    shared_.charge(other_bytes, now_us);
  }
  Result<void> acked(std::uint64_t total, TimeUs now_us) { return pace_.acked(total, now_us); }
  /// How many bytes may wait: what the link carries in a quarter of a second.
  std::size_t backlog_bytes() const {
    constexpr std::uint64_t kBacklogPerSecond = 4;
    return static_cast<std::size_t>(
        std::max<std::uint64_t>(kBacklogMin, pace_.rate() / kBacklogPerSecond));
  }
  /// Nothing waits although something might go.
  void ran_dry() { pace_.ran_dry(); }

 private:
  static constexpr std::size_t kBacklogMin = 64 * 1024;
  static constexpr std::size_t kTurnBytes = kFrameHeaderBytes + kFragmentBytesMax;

  ChunkPace pace_;
  bool is_paced_ = false;
  ByteBudget own_;
  ByteBudget& shared_;
  std::size_t credit_ = 0;         // of the turns that came
  std::optional<TimeUs> turn_us_;  // booked
};

}  // namespace runstone
