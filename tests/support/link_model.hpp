// LinkModel: one direction of a link in a model: a drop-tail queue, a transmitter of fixed rate, loss on the way, and
// a delay with jitter that never reorders. Pure: time is an argument, so that the lab's forwarder and shaper use it
// with the clock and tests in virtual time.
// Where packets come densely, none overtaking one that was held up longer makes nearly all of them as late as the
// latest; alone, each is early or late as it is drawn.
// One thread.
#pragma once
#include <cstdint>

#include "common/core/hash.hpp"
#include "tests/support/link_profile.hpp"

namespace runstone::test {

enum class LinkFate : std::uint8_t { arrives, lost, no_room };

struct LinkPassage {
  LinkFate fate = LinkFate::arrives;
  TimeNs due_ns = 0;  // when its last bit arrives, or would have; not of no_room
};

struct LinkCounts {
  std::uint64_t packets = 0, bytes = 0;  // that arrive
  std::uint64_t lost = 0, no_room = 0;   // packets
};

class LinkModel {
 public:
  LinkModel(const LinkProfile& profile, std::uint64_t seed) : profile_(profile), random_(seed) {}

  /// A packet comes to the link. Requires that `now_ns` never goes back. A lost one takes its time of the
  /// transmitter; one without room takes none. Dues never go back.
  LinkPassage push(std::uint64_t bytes, TimeNs now_ns);
  /// Bytes that wait for the transmitter or are in it.
  std::uint64_t queued_bytes(TimeNs now_ns) const;
  const LinkProfile& profile() const { return profile_; }
  const LinkCounts& counts() const { return counts_; }

 private:
  LinkProfile profile_;
  SplitMix64 random_;
  TimeNs free_ns_ = 0;  // when the transmitter is through with all it was given
  TimeNs last_due_ns_ = 0;
  LinkCounts counts_;
};

}  // namespace runstone::test
