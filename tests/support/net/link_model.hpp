// LinkModel: a model of one direction of a link: a drop-tail queue, a transmitter of fixed rate,
// loss, and a delay with jitter that never reorders. It is pure: time is an argument, so that the
// testbed's forwarder and shaper use it with the clock and tests in virtual time. No packet
// overtakes one that was delayed longer. So nearly all packets of a dense stream are as late as the
// latest one, and the delay of a lone packet is random. Thread: one.
#pragma once
#include <cstdint>

#include "common/core/hash.hpp"
#include "tests/support/net/link_profile.hpp"

namespace runstone::test {

enum class LinkFate : std::uint8_t { arrives, lost, no_room };

struct LinkPassage {
  LinkFate fate = LinkFate::arrives;
  // The time at which its last bit arrives, or would have arrived. Not set for no_room.
  TimeNs due_ns = 0;
};

struct LinkCounts {
  std::uint64_t packets = 0, bytes = 0;  // that arrive
  std::uint64_t lost = 0, no_room = 0;   // packets
};

class LinkModel {
 public:
  LinkModel(const LinkProfile& profile, std::uint64_t seed) : profile_(profile), random_(seed) {}

  /// Passes a packet to the link. Requires that `now_ns` never decreases. A lost packet uses its
  /// time of the transmitter; one without room uses none. Due times never decrease.
  LinkPassage push(std::uint64_t bytes, TimeNs now_ns);
  /// Returns the bytes that wait for the transmitter or are in it.
  std::uint64_t queued_bytes(TimeNs now_ns) const;
  const LinkProfile& profile() const { return profile_; }
  const LinkCounts& counts() const { return counts_; }

 private:
  LinkProfile profile_;
  SplitMix64 random_;
  TimeNs free_ns_ = 0;  // when the transmitter has sent everything
  TimeNs last_due_ns_ = 0;
  LinkCounts counts_;
};

}  // namespace runstone::test
