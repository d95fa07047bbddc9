// ChunkPace: computes how many bytes of terrain may be in flight to one client. Bytes in flight
// beyond the capacity of the link (rate times round trip) wait in a queue before its slowest part,
// and the next edit waits behind them. So rate and round trip are measured, and the bytes in flight
// are kept just above their product:
//   rate        The largest delivery rate of the last round trips. A sample is the number of bytes
//               that the client acknowledged, divided by the time that took, measured at the sender
//               or at the receiver, whichever is longer.
//   round trip  The shortest of the last seconds, from handing over a fragment to its
//               acknowledgement. When the shortest one is old, it is measured again with half as
//               many bytes in flight.
// At the start the bytes in flight double each round trip, until the rate stops growing. While
// round trips are longer, the bytes grow less fast: a queue may have begun, or the slow start of
// TCP below may hold bytes back.
// Sources: Cardwell et al., "BBR: Congestion-Based Congestion Control", ACM Queue 14(5), 2016; rate
// samples as in draft-cheng-iccrg-delivery-rate-estimation; the start with longer round trips after
// RFC 9406 (HyStart++).
// TCP still protects the network; this class protects the latency of edits. A client that
// acknowledges nothing gets kStartBytes, then one fragment a second. A client that acknowledges too
// much harms its own latency only, because TCP still limits what is sent.
// Pure: times are arguments (microseconds of one steady clock, never decreasing). One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "protocol/limits.hpp"

namespace runstone {

class ChunkPace {
 public:
  /// Counts bytes of frames of the class `chunks`, headers included, that were handed to the
  /// socket.
  void sent(std::size_t bytes, TimeUs now_us);
  /// Handles an acknowledgement: the client has read `total` bytes of such frames since the stream
  /// began. Fails (bad_value) if that is more than was sent, or less than it acknowledged before.
  Result<void> acked(std::uint64_t total, TimeUs now_us);
  /// Reports that there was room but nothing to send. Rates of the bytes in flight are then limited
  /// by the server, not by the link.
  void mark_app_limited() { app_limited_until_ = sent_; }

  /// Returns true if a fragment of fragment_bytes() may be sent now.
  bool may_send(TimeUs now_us) const;
  /// Returns when bytes may be sent again if no acknowledgement comes before; at least `now_us`.
  TimeUs next_us(TimeUs now_us) const;
  /// Returns the body bytes of one fragment: fewer on a slow link, so that an edit waits less.
  std::size_t fragment_bytes() const;
  std::uint64_t in_flight() const { return sent_ - acked_; }
  /// Returns bytes a second, or 0 if not measured yet.
  std::uint64_t rate() const;
  /// Returns 0 if not measured yet.
  TimeUs round_trip_us() const { return round_trip_us_; }
  /// Returns how many bytes may be in flight.
  std::uint64_t window() const;

  static constexpr std::size_t kStartBytes = 2 * kFragmentBytesMax;
  static constexpr std::size_t kFloorBytes = 8 * 1024;
  static constexpr TimeUs kSilenceUs = 1'000'000;

 private:
  enum class Phase { start, steady, remeasure };
  /// The state when a fragment was sent.
  struct Fragment {
    std::uint64_t end = 0;  // bytes sent, this fragment included
    TimeUs sent_us = 0;
    std::uint64_t acked = 0;
    TimeUs acked_us = 0, first_sent_us = 0;
    bool is_app_limited = false;
  };
  TimeUs silent_until() const { return last_ack_us_ + kSilenceUs; }
  std::uint64_t unreported_bytes() const;
  std::uint64_t gain_percent() const;
  bool is_full() const;
  bool is_late() const;
  void leave_start();
  void take_rate(const Fragment& newest, TimeUs now_us);
  void take_round_trip(const Fragment& newest, TimeUs now_us);
  void end_round();
  void step_remeasure(const Fragment& newest, TimeUs round_trip_us, TimeUs now_us);

  Phase phase_ = Phase::start;
  TimeUs next_us_ = 0;  // when the rate allows more
  std::deque<Fragment>
      fragments_;  // not acknowledged to the end, oldest first; at most kFragmentsMax
  std::uint64_t sent_ = 0, acked_ = 0;
  TimeUs last_ack_us_ =
      0;                 // of the last acknowledgement, or of the first fragment after all was read
  TimeUs acked_us_ = 0;  // when acked_ last rose, or was made to begin
  TimeUs first_sent_us_ = 0;  // when the fragment last acknowledged was sent
  std::uint64_t app_limited_until_ = 0;

  // Rate: the largest of this span and of the one before it.
  std::uint64_t rate_ = 0, rate_before_ = 0;
  TimeUs rate_since_us_ = 0;

  // Round trip.
  TimeUs round_trip_us_ = 0, measured_us_ = 0;  // the shortest, and when it was measured last
  TimeUs smooth_us_ = 0, swing_us_ = 0;         // as TCP's smoothed round trip and its variation
  std::uint64_t remeasure_from_ = 0, remeasure_to_ = 0;  // of bytes sent; 0: not drained yet
  TimeUs remeasured_us_ = 0;
  unsigned late_in_a_row_ = 0;

  // Rounds: each ends when the bytes that were sent when it began are acknowledged.
  std::uint64_t round_end_ = 0;
  unsigned rounds_ = 0;      // since the last probe
  unsigned probes_won_ = 0;  // in a row; the rate is raised fast after the first
  bool is_probing_ = false, is_judging_ = false, is_draining_ = false;
  std::uint64_t rate_at_growth_ = 0;
  unsigned rounds_without_growth_ = 0;
};

}  // namespace runstone
