// LinkProfile: the properties of an access link, and the links of the network testbed.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>

namespace runstone::test {

/// Nanoseconds of a steady clock, and differences of it.
using TimeNs = std::int64_t;

/// Both directions have the same properties.
struct LinkProfile {
  std::string_view name;
  TimeNs round_trip_ns = 0;
  TimeNs jitter_ns = 0;  // each way is longer or shorter by up to this; at most half a round trip
  std::uint64_t bits_per_second = 0;  // 0: without limit
  double loss = 0;                    // share of packets lost on the way, 0 .. 1

  /// Returns the queue before the link, in bytes: what the link carries in one round trip, 64 KiB
  /// at least. A packet that finds no room is dropped (drop-tail).
  std::uint64_t queue_bytes() const;
  /// Returns the time in which the link sends so many bytes.
  TimeNs transmit_ns(std::uint64_t bytes) const;
  bool passes_all() const { return round_trip_ns == 0 && bits_per_second == 0 && loss == 0; }
};

/// Returns loopback, lan, broadband, mobile, lossy, in this order.
std::span<const LinkProfile> link_profiles();
/// Returns null if there is no profile of that name.
const LinkProfile* find_link_profile(std::string_view name);

}  // namespace runstone::test
