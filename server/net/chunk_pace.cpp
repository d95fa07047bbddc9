#include "server/net/chunk_pace.hpp"

#include <algorithm>
#include <utility>

namespace runstone {
namespace {

constexpr std::uint64_t kSecondUs = 1'000'000;
constexpr std::size_t kFragmentsMax = 2'048;  // further ones are counted with the last one
// More than any link needs, and small enough that no product overflows.
constexpr std::uint64_t kWindowMax = 256ULL << 20;
constexpr std::uint64_t kRateMax = 100'000'000'000;  // bytes a second
constexpr TimeUs kRateSpanUsMin = 250'000;           // a rate is valid for one to two spans
constexpr TimeUs kRateSpanRoundTrips = 5;
constexpr TimeUs kRoundTripAgeUsMax = 5'000'000;
constexpr unsigned kRoundsWithoutGrowthMax = 2;
// A queue has begun when so many round trips in a row are longer by an eighth. These bounds limit
// the eighth.
constexpr unsigned kLateInARow = 4;
constexpr TimeUs kQueueUsMin = 4'000, kQueueUsMax = 16'000;
constexpr TimeUs kFragmentUs = 2'000;  // the time that the link needs for a fragment
constexpr std::size_t kFragmentBytesMin = 2 * 1024;
// A fragment may be sent so long before its time, so that the writer wakes up less often. A writer
// that is late makes up for so much.
constexpr TimeUs kAheadUs = 1'000;
constexpr TimeUs kLateUsMax = 2'000;
// Percentages of the rate. Slightly less than the rate empties the queue that a probe has made.
constexpr std::uint64_t kStartGain = 200, kLateStartGain = 125, kSteadyGain = 98, kDrainGain = 80,
                        kProbeGainMin = 110, kProbeGainMax = 125, kWonGain = 150;
constexpr unsigned kRoundsPerProbe = 6;

std::uint64_t bytes_in(std::uint64_t rate, TimeUs us) {
  return std::min(rate, kRateMax) *
         static_cast<std::uint64_t>(std::clamp<TimeUs>(us, 0, 60'000'000)) / kSecondUs;
}

}  // namespace

std::uint64_t ChunkPace::rate() const { return std::max(rate_, rate_before_); }

std::size_t ChunkPace::fragment_bytes() const {
  if (rate() == 0) return kFragmentBytesMin;
  return static_cast<std::size_t>(std::clamp<std::uint64_t>(bytes_in(rate(), kFragmentUs),
                                                            kFragmentBytesMin, kFragmentBytesMax));
}

// Returns the bytes that the client may have read but not acknowledged yet.
std::uint64_t ChunkPace::unreported_bytes() const {
  return std::min(
      bytes_in(rate(), kReceiveAckEveryUs),
      std::max<std::uint64_t>(kReceiveAckEveryBytes, bytes_in(rate(), kReceiveAckUsMin)));
}

std::uint64_t ChunkPace::window() const {
  if (rate() == 0) return kStartBytes;
  const std::uint64_t link = bytes_in(rate(), round_trip_us_);
  if (phase_ == Phase::remeasure) return std::max<std::uint64_t>(link / 2, kFloorBytes);
  // A link of varying delay holds more bytes than its shortest round trip suggests.
  const std::uint64_t uneven = bytes_in(rate(), std::min(2 * swing_us_, round_trip_us_ / 3));
  const std::uint64_t steady = link + unreported_bytes() + uneven + kFragmentBytesMax;
  const std::uint64_t start = (is_late() ? link + link / 4 : 2 * link) + unreported_bytes();
  const std::uint64_t window = phase_ == Phase::start ? std::max(start, steady) : steady;
  return std::min(window, kWindowMax);
}

std::uint64_t ChunkPace::gain_percent() const {
  if (phase_ == Phase::start) return is_late() ? kLateStartGain : kStartGain;
  if (is_draining_) return kDrainGain;
  if (!is_probing_) return kSteadyGain;
  if (probes_won_ > 0) return kWonGain;
  // A probe sends at least one fragment more in a round trip.
  const std::uint64_t link = std::max<std::uint64_t>(1, bytes_in(rate(), round_trip_us_));
  return std::clamp<std::uint64_t>(100 + 100 * kFragmentBytesMax / link, kProbeGainMin,
                                   kProbeGainMax);
}

bool ChunkPace::is_late() const { return late_in_a_row_ >= kLateInARow; }

// Less room than a fragment counts as none, so that fragments do not become small.
bool ChunkPace::is_full() const { return in_flight() + fragment_bytes() > window(); }

bool ChunkPace::may_send(TimeUs now_us) const {
  if (is_full()) return now_us >= silent_until();
  return rate() == 0 || next_us_ <= now_us + kAheadUs;
}

TimeUs ChunkPace::next_us(TimeUs now_us) const {
  return std::max(now_us, is_full() ? silent_until() : next_us_);
}

void ChunkPace::sent(std::size_t bytes, TimeUs now_us) {
  if (in_flight() == 0) {
    // The link was idle: rates are measured from now on.
    acked_us_ = first_sent_us_ = last_ack_us_ = now_us;
  } else if (now_us >= silent_until() && is_full()) {
    last_ack_us_ = now_us;  // the next fragment waits for another kSilenceUs
  }
  sent_ += bytes;
  if (rate() != 0) {
    const std::uint64_t pace = std::max<std::uint64_t>(1, rate() * gain_percent() / 100);
    next_us_ =
        std::max(next_us_, now_us - kLateUsMax) + static_cast<TimeUs>(bytes * kSecondUs / pace);
  }
  if (fragments_.size() >= kFragmentsMax) {
    fragments_.back().end = sent_;
    return;
  }
  fragments_.push_back(
      {sent_, now_us, acked_, acked_us_, first_sent_us_, app_limited_until_ > acked_});
}

Result<void> ChunkPace::acked(std::uint64_t total, TimeUs now_us) {
  if (total > sent_)
    return fail(ErrorCode::bad_value, "receive ack counts more chunk bytes than were sent", total);
  if (total < acked_)
    return fail(ErrorCode::bad_value, "receive ack counts fewer chunk bytes than before", total);
  if (total == acked_) return {};
  acked_ = total;
  acked_us_ = last_ack_us_ = now_us;
  Fragment newest;
  bool is_whole = false;  // a fragment was acknowledged to its end
  while (!fragments_.empty() && fragments_.front().end <= total) {
    newest = fragments_.front();
    fragments_.pop_front();
    is_whole = true;
  }
  if (!is_whole) return {};
  take_rate(newest, now_us);
  if (is_draining_ && in_flight() <= bytes_in(rate(), round_trip_us_) + unreported_bytes() / 2)
    is_draining_ = false;
  first_sent_us_ = newest.sent_us;
  take_round_trip(newest, now_us);
  if (newest.acked >= round_end_) {
    round_end_ = acked_;
    end_round();
  }
  return {};
}

void ChunkPace::take_rate(const Fragment& newest, TimeUs now_us) {
  const TimeUs span_us = std::max(now_us - newest.acked_us, newest.sent_us - newest.first_sent_us);
  // A shorter time than any round trip means that acknowledgements arrived together.
  if (span_us <= 0 || span_us < round_trip_us_) return;
  const std::uint64_t rate =
      std::min(kRateMax, (acked_ - newest.acked) * kSecondUs / static_cast<std::uint64_t>(span_us));
  const TimeUs valid_us = std::max(kRateSpanUsMin, kRateSpanRoundTrips * round_trip_us_);
  if (now_us - rate_since_us_ > valid_us && (!newest.is_app_limited || rate > rate_)) {
    rate_before_ = std::exchange(rate_, 0);
    rate_since_us_ = now_us;
  }
  // If there was nothing to send, a lower rate says nothing about the link.
  if (rate > rate_ && (!newest.is_app_limited || rate > this->rate())) rate_ = rate;
}

void ChunkPace::take_round_trip(const Fragment& newest, TimeUs now_us) {
  const TimeUs round_trip_us = std::max<TimeUs>(1, now_us - newest.sent_us);
  if (smooth_us_ == 0) {
    smooth_us_ = round_trip_us;
  } else {
    const TimeUs off_us = std::abs(round_trip_us - smooth_us_);
    swing_us_ += (off_us - swing_us_) / 8;
    smooth_us_ += (round_trip_us - smooth_us_) / 8;
  }
  if (phase_ == Phase::remeasure) return step_remeasure(newest, round_trip_us, now_us);
  if (round_trip_us_ == 0 || round_trip_us <= round_trip_us_) {
    round_trip_us_ = round_trip_us;
    measured_us_ = now_us;
  } else if (phase_ == Phase::steady && now_us - measured_us_ > kRoundTripAgeUsMax) {
    phase_ = Phase::remeasure;
    remeasure_from_ = 0;
    remeasured_us_ = 0;
  }
  const TimeUs queue_us =
      std::clamp<TimeUs>(round_trip_us_ / 8, kQueueUsMin, kQueueUsMax) + 2 * swing_us_;
  late_in_a_row_ = round_trip_us > round_trip_us_ + queue_us ? late_in_a_row_ + 1 : 0;
}

void ChunkPace::step_remeasure(const Fragment& newest, TimeUs round_trip_us, TimeUs now_us) {
  if (remeasure_from_ == 0) {
    if (in_flight() > window()) return;
    remeasure_from_ = sent_;
    remeasure_to_ = sent_ + window();
    return;
  }
  if (newest.end <= remeasure_from_) return;  // sent while the queue was there
  remeasured_us_ = remeasured_us_ == 0 ? round_trip_us : std::min(remeasured_us_, round_trip_us);
  if (acked_ < remeasure_to_ && in_flight() > 0) return;
  round_trip_us_ = remeasured_us_;
  measured_us_ = now_us;
  phase_ = Phase::steady;
}

void ChunkPace::end_round() {
  if (phase_ == Phase::steady) {
    if (is_probing_) {
      is_probing_ = false;
      is_judging_ = is_draining_ = true;  // the probe's bytes are acknowledged a round trip later
      return;
    }
    if (is_judging_) {
      is_judging_ = false;
      const bool won = rate() * 100 >= rate_at_growth_ * 105;
      probes_won_ = won ? probes_won_ + 1 : 0;
      if (won) is_draining_ = false;
    }
    if (is_draining_) return;
    if (++rounds_ >= kRoundsPerProbe || probes_won_ > 0) {
      rounds_ = 0;
      is_probing_ = true;
      rate_at_growth_ = rate();
    }
    return;
  }
  if (phase_ != Phase::start) return;
  if (app_limited_until_ > acked_) return;
  if (rate() * 4 >= rate_at_growth_ * 5) {
    rate_at_growth_ = rate();
    rounds_without_growth_ = 0;
  } else if (++rounds_without_growth_ >= kRoundsWithoutGrowthMax || is_late()) {
    leave_start();
  }
}

void ChunkPace::leave_start() {
  phase_ = Phase::steady;
  is_draining_ = true;
}

}  // namespace runstone
