// ClockOffset: how far the server's steady clock is from ours, from ping and pong.
// Source: Cristian 1989: the reply with the shortest round trip says most; the truth is within half of that
// trip.
#pragma once
#include <array>
#include <cstddef>
#include <optional>

#include "common/core/ids.hpp"

namespace runstone {

class ClockOffset {
 public:
  /// `sent_us` and `received_us` on our clock, `server_us` on the server's. Ignored if the trip is negative.
  void add(TimeUs sent_us, TimeUs server_us, TimeUs received_us);
  /// Forgets everything: the server was restarted, so its clock is another one.
  void reset() { count_ = 0; }

  bool known() const { return count_ != 0; }
  /// Server clock minus ours. Requires known().
  TimeUs offset_us() const;
  /// Largest possible error of offset_us(): half the shortest round trip of the last kSamples. Requires
  /// known().
  TimeUs error_us() const;
  TimeUs round_trip_us() const;
  std::optional<TimeUs> to_server(TimeUs local_us) const;
  std::optional<TimeUs> to_local(TimeUs server_us) const;

  static constexpr std::size_t kSamples =
      16;  // at one ping a second, drift stays below the error of a LAN

 private:
  struct Sample {
    TimeUs round_trip_us = 0, offset_us = 0;
  };
  const Sample& best() const;
  std::array<Sample, kSamples> samples_{};
  std::size_t count_ = 0;  // samples ever taken
};

}  // namespace runstone
