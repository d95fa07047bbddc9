// WorldCounters: what the world strand did since the start. Load is shown by these, not by log lines.
#pragma once
#include <cstdint>

namespace runstone {

struct WorldCounters {
  std::uint64_t sessions_opened = 0;  // got ready
  std::uint64_t sessions_closed = 0;  // by the server, with a reason
  std::uint64_t messages = 0;         // received
  std::uint64_t edits_ordered = 0;
  std::uint64_t edits_rejected = 0;
  std::uint64_t commits = 0;
  std::uint64_t commit_bytes = 0;  // serialised once each
  std::uint64_t commits_sent = 0;  // commit times receiver
  std::uint64_t snapshots_sent = 0;
  std::uint64_t uniform_messages = 0;  // each with many of these
  std::uint64_t same_sent = 0;         // chunk times session: it held the chunk as it is
  std::uint64_t updates_sent =
      0;  // likewise: it held an earlier version, and its edits may be fewer
  std::uint64_t claims_drifted =
      0;  // held at the right version with other voxels: a snapshot repaired it
  std::uint64_t chunks_requested =
      0;  // asked for again: a gap, or an audit that found a difference
  std::uint64_t unavailable_sent = 0;  // chunk times session: told that there is none
  std::uint64_t chunks_stale = 0;  // chunk times session, because a commit did not fit its queue
  std::uint64_t queue_full = 0;    // sends refused by a session's queue
  std::uint64_t audits_sent = 0;
  std::uint64_t audit_mismatches =
      0;  // published digest differs from its runs: a bug or broken memory
  std::uint64_t chunks_failed = 0;  // loads that ended in quarantine
};

}  // namespace runstone
