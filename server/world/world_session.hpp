// WorldSession: what the world strand knows of one connection, and the states it goes through:
//   awaits_hello -> awaits_proof -> open. Closing forgets it at once.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "protocol/codec/messages.hpp"
#include "server/world/token_bucket.hpp"

namespace runstone {

enum class SessionState { awaits_hello, awaits_proof, open };

struct WorldSession {
  SessionState state = SessionState::awaits_hello;
  TimeUs connected_us = 0;  // steady clock, as the others
  TimeUs heard_us = 0;      // last message
  PublicKey key{};
  ClientInstance instance = 0;
  std::string name;
  Bytes proof_transcript;  // what the client has to sign; empty outside of awaits_proof
  AuthorId author = 0;     // from open on
  Pose pose;
  bool pose_changed = false;  // since the last poses
  bool owes_durable = false;  // the watermark did not fit its queue: again on the next tick
  std::vector<Reject> owed;   // answers that did not fit its queue, in order: again when it drains
  TokenBucket edits{0, 0};
  std::optional<TimeUs>
      stalled_us;  // its queue was full then: no snapshots until drained or the retry interval
};

}  // namespace runstone
