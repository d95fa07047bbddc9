// WorldCounters: counts of what the world strand did since the start. They show the load, which log
// lines do not. "Chunk times session" counts a chunk once for each session.
#pragma once
#include <cstdint>

namespace runstone {

struct WorldCounters {
  std::uint64_t sessions_opened = 0;  // authenticated and accepted
  std::uint64_t sessions_closed = 0;  // by the server, with a reason
  std::uint64_t messages = 0;         // received
  std::uint64_t edits_ordered = 0;
  std::uint64_t edits_rejected = 0;
  std::uint64_t commits = 0;
  std::uint64_t commit_bytes = 0;  // of the messages; sessions that get the same edits share one
  std::uint64_t commits_sent = 0;  // commit times session that got edits of it
  std::uint64_t snapshots_sent = 0;
  // Tile times session, again after each change.
  std::uint64_t tiles_sent = 0;
  // Tile times session: the client's copy was current.
  std::uint64_t tiles_not_modified = 0;
  // Messages that carry many uniform chunks each.
  std::uint64_t uniform_messages = 0;
  // Chunk times session: the client's copy had the same version and digest.
  std::uint64_t not_modified_sent = 0;
  // Chunk times session: the client's copy had an earlier version.
  std::uint64_t updates_sent = 0;
  // Claims at the right version with other voxels. A snapshot repairs the copy.
  std::uint64_t claims_drifted = 0;
  // Chunks that a client requested again, after a gap or a digest check that failed.
  std::uint64_t chunks_requested = 0;
  // Chunk times session: "chunk unavailable" was sent.
  std::uint64_t unavailable_sent = 0;
  // Chunk times session: a commit did not fit the session's queue.
  std::uint64_t chunks_stale = 0;
  // Messages that did not fit a session's queue.
  std::uint64_t queue_full = 0;
  std::uint64_t digest_checks_sent = 0;
  // Published digests that differ from their runs: a bug or broken memory.
  std::uint64_t digest_mismatches = 0;
  // Loads that ended in quarantine.
  std::uint64_t chunks_failed = 0;
};

}  // namespace runstone
