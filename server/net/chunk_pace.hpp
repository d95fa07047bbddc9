// ChunkPace: how many bytes of terrain may be on their way to one client. What is on its way beyond what the link
// itself holds (rate times round trip) lies in a queue before the link's slowest part, and the next edit waits behind
// it. So the rate and the round trip are measured, and what is under way is kept just above their product:
//   rate        the largest delivery rate of the last round trips, each a quotient of bytes the client said it read and
//               the time this took, counted from the sender's or the receiver's side, whichever is longer
//   round trip  the shortest of the last seconds, from handing over a fragment to the client's word that it was read;
//               measured anew with half as much under way when the shortest one is old
// At the start the bytes under way double each round trip, until the rate grows no more. While round trips are longer they
// grow less fast: a queue may have begun, or TCP below has its own start before it, in which bytes wait for it.
// After BBR: Cardwell et al., "BBR: Congestion-Based Congestion Control", ACM Queue 14(5), 2016; rate samples as in
// draft-cheng-iccrg-delivery-rate-estimation; the start with longer round trips after RFC 9406 (HyStart++).
// TCP goes on to guard the network; this guards the next edit. Pure: times are arguments (microseconds of one steady
// clock, never going back). One thread. A client that says nothing gets kStartBytes, then one fragment a second; one
// that claims too much harms its own latency only, since TCP still bounds what it is sent.
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
  /// Bytes of frames of the class `chunks`, headers included, were handed to the socket.
  void sent(std::size_t bytes, TimeUs now_us);
  /// The client has read `total` bytes of such frames since the stream began. bad_value if that is more than was
  /// sent, or less than it said before.
  Result<void> acked(std::uint64_t total, TimeUs now_us);
  /// There was room but nothing to send: what is under way now says nothing of how much the link could carry.
  void ran_dry() { dry_until_ = sent_; }

  /// Bytes that may go now.
  std::size_t room(TimeUs now_us) const;
  /// When something may go again if no word comes before; not before `now_us`.
  TimeUs next_us(TimeUs now_us) const;
  /// Bytes of a body that go as one fragment: less on a slow link, so that an edit waits less.
  std::size_t fragment_bytes() const;
  std::uint64_t in_flight() const { return sent_ - acked_; }
  /// Bytes per second; 0: not measured yet.
  std::uint64_t rate() const;
  /// 0: not measured yet.
  TimeUs round_trip_us() const { return round_trip_us_; }
  /// Bytes that may be under way.
  std::uint64_t window() const;

  static constexpr std::size_t kStartBytes = 2 * kFragmentBytesMax;
  static constexpr std::size_t kFloorBytes = 8 * 1024;
  static constexpr TimeUs kSilenceUs = 1'000'000;

 private:
  enum class Phase { start, steady, remeasure };
  struct Fragment {         // what was known when it went
    std::uint64_t end = 0;  // bytes sent, this one included
    TimeUs sent_us = 0;
    std::uint64_t acked = 0;
    TimeUs acked_us = 0, first_sent_us = 0;
    bool is_dry = false;
  };
  TimeUs silent_until() const { return heard_us_ + kSilenceUs; }
  std::uint64_t untold() const;
  std::uint64_t gain_percent() const;
  bool is_full() const;
  bool is_late() const;
  void leave_start();
  void take_rate(const Fragment& newest, TimeUs now_us);
  void take_round_trip(const Fragment& newest, TimeUs now_us);
  void end_round();
  void step_remeasure(const Fragment& newest, TimeUs round_trip_us, TimeUs now_us);

  Phase phase_ = Phase::start;
  TimeUs next_us_ = 0;              // when the rate allows more
  std::deque<Fragment> fragments_;  // not all read yet, oldest first; kFragmentsMax at most
  std::uint64_t sent_ = 0, acked_ = 0;
  TimeUs heard_us_ = 0;  // of the last acknowledgement, or of the first fragment after all was read
  TimeUs acked_us_ = 0;  // when acked_ last rose, or was made to begin
  TimeUs first_sent_us_ = 0;  // when the fragment last acknowledged was sent
  std::uint64_t dry_until_ = 0;

  // Rate: the largest of this span and of the one before it.
  std::uint64_t rate_ = 0, rate_before_ = 0;
  TimeUs rate_since_us_ = 0;

  // Round trip.
  TimeUs round_trip_us_ = 0, measured_us_ = 0;  // the shortest, and when it was last seen
  TimeUs smooth_us_ = 0, swing_us_ = 0;         // as TCP's smoothed round trip and its variation
  std::uint64_t remeasure_from_ = 0, remeasure_to_ = 0;  // of bytes sent; 0: not drained yet
  TimeUs remeasured_us_ = 0;
  unsigned late_in_a_row_ = 0;

  // Rounds: a round trip each, by what was sent when it began.
  std::uint64_t round_end_ = 0;
  unsigned rounds_ = 0;      // since the last probe
  unsigned probes_won_ = 0;  // in a row: a faster link is followed fast
  bool is_probing_ = false, is_judging_ = false, is_draining_ = false;
  std::uint64_t rate_at_growth_ = 0;
  unsigned rounds_without_growth_ = 0;
};

}  // namespace runstone
