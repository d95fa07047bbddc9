// DigestChecks: the server recomputes digests of a session's chunks from their runs and sends
// them, and the client compares. Each check covers the session's next chunks, round robin. The
// sessions are served round robin too, a few on each tick, so that with many sessions the checks do
// not delay edits.
// Thread: the world strand.
#pragma once
#include "server/world/ground/ground_base.hpp"

namespace runstone {

class DigestChecks {
 public:
  explicit DigestChecks(GroundBase& base) : base_(base) {}

  /// Sends the digest checks that are due: one to every session in digest_check_interval_us. Call
  /// it on every tick. Cost: O(their digests).
  void send_due(const Clocks& now);

 private:
  Digest checked_digest(const ChunkKey& key, const Chunk& chunk, std::size_t& runs_left);
  void send(Viewer& viewer, std::size_t& runs_left);

  GroundBase& base_;
  TimeUs sent_us_ = 0;           // up to this time, all that were due are sent
  SessionId served_last_ = 0;    // the session served last
  bool are_runs_short_ = false;  // not all chunks of the last checks were hashed
};

}  // namespace runstone
