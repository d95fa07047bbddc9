// ChunkUpdater: what a message of the server does to one chunk of the live world. It brings the
// confirmed chunk forward, finds gaps and drift, requests snapshots, and shows the confirmed runs
// with the pending edits on top. One thread.
#pragma once
#include <span>
#include <utility>
#include <vector>

#include "client/replica/change_queue.hpp"
#include "client/replica/replica_changes.hpp"
#include "client/replica/replica_chunks.hpp"
#include "client/replica/shown_runs.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Edits held back per chunk.
inline constexpr std::size_t kInboxEditsMax = 1024;
/// A request without a snapshot is repeated after this.
inline constexpr TimeUs kRequestAgainUs = 2'000'000;

class ChunkUpdater {
 public:
  /// All three must outlive this object.
  ChunkUpdater(ReplicaChunks& chunks, ChangeQueue& changes, ReplicaCounters& counters)
      : chunks_(chunks), changes_(changes), counters_(counters), shown_(chunks, changes) {}

  /// Takes a snapshot, and applies the edits in the inbox that follow. Returns false if the
  /// confirmed chunk is as new and not in doubt: then the snapshot is ignored.
  bool apply_snapshot(TrackedChunk& chunk, Chunk snapshot, TimeUs now_us);
  /// Takes a snapshot of another moment, whatever its version. Applies nothing.
  void replace(TrackedChunk& chunk, Chunk snapshot);
  /// Takes the answer that the claimed chunk is current at `seq`. Requests a snapshot if the
  /// confirmed chunk is older.
  void apply_not_modified(TrackedChunk& chunk, Sequence seq, TimeUs now_us);
  /// Takes the edits that a claimed chunk lacked. Requests a snapshot if they do not follow the
  /// confirmed chunk, or if the digest differs after them. Returns true if they became part of the
  /// confirmed chunk.
  bool apply_missing_edits(TrackedChunk& chunk, const ChunkEdits& update, TimeUs now_us);
  /// Takes the answer that the server cannot send the chunk.
  void set_unavailable(TrackedChunk& chunk, UnavailableReason reason);
  /// Takes a chunk from a cache. The server has not vouched for it. Requires a chunk without a
  /// confirmed one.
  void adopt(TrackedChunk& chunk, ChunkPtr cached, TimeUs now_us);

  /// Appends an ordered edit to the inbox. `may_wait`: the edit may have to wait for the
  /// server's answer about the chunk. Then the inbox is bounded by kInboxEditsMax and
  /// kPatchSpansMax: beyond them, the edits are dropped, and a snapshot that contains them is
  /// requested later.
  void add_to_inbox(TrackedChunk& chunk, TrackedChunk::InboxEdit edit, bool may_wait);
  /// Applies what follows in the inbox, requests a snapshot at a gap, and shows the result. Does
  /// nothing without a confirmed chunk, and while a snapshot is awaited.
  void advance(TrackedChunk& chunk, TimeUs now_us) { advance(chunk, false, now_us); }
  /// Compares the chunk with a digest of the server. Requests a snapshot if it differs at equal
  /// version, or if the check before named a version that the chunk has not reached.
  void check_digest(TrackedChunk& chunk, const DigestCheckEntry& check, TimeUs now_us);

  /// Shows a new pending edit on top of what is shown.
  void predict(TrackedChunk& chunk, const EditDescriptor& edit, EditChange& cause);
  /// Shows the confirmed runs with the pending edits on top. Requires a confirmed chunk.
  void show(TrackedChunk& chunk, std::span<EditChange* const> cause = {});
  /// Queues that the chunk is not shown any more. Call it before the replica erases the chunk.
  void forget(const TrackedChunk& chunk) { shown_.forget(chunk); }

  /// Requests a snapshot, and applies nothing else to the chunk until it arrives.
  void request(TrackedChunk& chunk, TimeUs now_us);
  /// Repeats the requests that are kRequestAgainUs old.
  void tick(TimeUs now_us);
  /// Returns the chunks to request from the server, ascending.
  std::vector<ChunkKey> take_requests() { return std::exchange(requests_, {}); }
  void clear_requests() { requests_.clear(); }

 private:
  void advance(TrackedChunk& chunk, bool from_snapshot, TimeUs now_us);
  void vouch(TrackedChunk& chunk, TimeUs now_us);
  bool is_needed(TrackedChunk& chunk, const Chunk& snapshot, bool was_vouched);
  void apply_ready(const TrackedChunk::ReadyEdits& taken, VoxelPos origin, Chunk& chunk);

  ReplicaChunks& chunks_;
  ChangeQueue& changes_;
  ReplicaCounters& counters_;
  ShownRuns shown_;
  std::vector<ChunkKey> requests_;  // ascending
  ApplyScratch scratch_;
};

}  // namespace runstone
