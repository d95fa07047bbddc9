// ClockOffset: the difference between the server's steady clock and this client's, estimated from
// pings and pongs. Source: Cristian 1989. The reply with the shortest round trip is the best
// estimate. Its error is at most half of that round trip.
#pragma once
#include <array>
#include <cstddef>
#include <optional>

#include "common/core/ids.hpp"

namespace runstone {

class ClockOffset {
 public:
  /// Adds a sample. `sent_us` and `received_us` are on this client's clock, `server_us` is on the
  /// server's. Ignored if the round trip is negative.
  void add(TimeUs sent_us, TimeUs server_us, TimeUs received_us);
  /// Drops all samples, because a restarted server has another clock.
  void reset() { count_ = 0; }

  bool known() const { return count_ != 0; }
  /// Returns the server's clock minus this client's. Requires known().
  TimeUs offset_us() const;
  /// Returns the largest possible error of offset_us(): half the shortest round trip of the last
  /// kSamples samples. Requires known().
  TimeUs error_us() const;
  TimeUs round_trip_us() const;
  /// Return nullopt unless known().
  std::optional<TimeUs> to_server(TimeUs local_us) const;
  std::optional<TimeUs> to_local(TimeUs server_us) const;

  /// At one ping a second, clock drift within these samples stays below the error on a LAN.
  static constexpr std::size_t kSamples = 16;

 private:
  struct Sample {
    TimeUs round_trip_us = 0, offset_us = 0;
  };
  const Sample& best() const;
  std::array<Sample, kSamples> samples_{};
  std::size_t count_ = 0;  // samples added since the last reset()
};

}  // namespace runstone
