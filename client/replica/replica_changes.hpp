// ReplicaChanges: what changed in a replica since its changes were last drained. The mesher, the
// latency recorder and the user interface read them.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/apply/stack_depths.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// When a message arrived, on the client's steady clock.
struct Arrival {
  TimeUs received_us = 0;  // its last byte was read from the socket
  TimeUs unpacked_us = 0;  // it was decoded and verified
  TimeUs now_us = 0;       // the replica applies it
};

/// The changed layers that the mesh of a chunk depends on, in the form of the arguments of
/// mesh_rdm_layers().
struct ChangedLayers {
  DirtyLayers here;  // layers in which a shown voxel changed
  /// By Direction: all changed layers of the neighbour, if the layer that touches this chunk
  /// changed; else empty.
  std::array<DirtyLayers, kDirectionCount> beyond;
  ChangedLayers& operator|=(const ChangedLayers& other) {
    here |= other.here;
    for (std::size_t d = 0; d < beyond.size(); ++d) beyond[d] |= other.beyond[d];
    return *this;
  }
  friend bool operator==(const ChangedLayers&, const ChangedLayers&) = default;
};

/// How soon a change should be on the screen. A greater value comes first.
enum class Urgency : std::uint8_t {
  terrain,     // chunks that arrived, and those beside them
  edit,        // edits of others
  local_edit,  // an edit of this client
};

/// One chunk whose mesh is out of date. Changes of a chunk are merged until they are drained.
struct ChunkChange {
  ChunkKey key;
  std::uint64_t serial = 0;  // see Replica::shown_serial()
  ChangedLayers layers;      // all that changed, except by neighbours that entered or left the view
  bool whole = false;        // nothing was shown here before, or at some time in between
  bool removed = false;      // out of view or unavailable: nothing is shown here
  std::vector<OperationId> edits;  // edits that this change contains, in the order applied
  bool has_local_edit = false;     // one of them was made by this client instance
};

inline Urgency urgency_of(const ChunkChange& change) {
  if (change.has_local_edit) return Urgency::local_edit;
  return change.edits.empty() ? Urgency::terrain : Urgency::edit;
}

/// One edit that was applied in the replica: as a prediction, or at its place in the confirmed
/// order.
struct EditChange {
  OperationId op;
  Sequence seq = 0;          // 0 for a prediction
  Sequence subject = 0;      // the earlier edit that a rollback, undo or redo refers to; 0: none
  bool is_local = false;     // made by this client instance
  bool predicted = false;    // shown before the server's answer
  bool in_snapshot = false;  // arrived with a snapshot, while its commit was held back
  // Server steady clock, unused for predictions. submitted_us: 0 if unknown.
  TimeUs submitted_us = 0, ordered_us = 0;
  // This client's steady clock.
  TimeUs received_us = 0, unpacked_us = 0, applied_us = 0;
  /// Chunks to mesh again because of this edit, neighbours at a border included. Empty if nothing
  /// visible changed.
  std::vector<ChunkKey> chunks;
};

/// The server rejected a local edit. Its prediction has been removed.
struct RejectedEdit {
  ClientSequence seq = 0;
  RejectReason reason = RejectReason::busy;
  std::string detail;
  /// The session offers the edit again, as a new one (LocalEdit::again_of).
  bool is_offered_again = false;
};

/// The server cannot send a chunk of the view.
struct UnavailableChunk {
  ChunkKey key;
  UnavailableReason reason = UnavailableReason::damaged;
};

struct ReplicaChanges {
  std::vector<ChunkChange> chunks;  // ascending by key
  std::vector<EditChange> edits;    // in the order applied
  std::vector<RejectedEdit> rejects;
  std::vector<ClientSequence> durable;  // local edits that are known to be on disk now
  /// Local edits that the server resolved, and whose commits will not arrive: the connection was
  /// lost, or a commit did not fit the session's send queue on the server. They were applied and
  /// are durable, or were rejected: the chunks show which.
  std::vector<ClientSequence> unseen;
  std::vector<UnavailableChunk> unavailable;
  std::vector<ChunkKey> tiles;  // of FarTiles that arrived, changed or left; ascending
};

/// Counts since the replica was made. A `chunk edit` is an edit in one chunk: an edit counts once
/// per chunk. The counts of local edits are LocalEditCounters.
struct ReplicaCounters {
  std::uint64_t snapshots_taken = 0;  // became the confirmed chunk
  std::uint64_t snapshots_stale = 0;  // older than the confirmed chunk: ignored
  /// Answers of the server for chunks that are not in view, or left it since: ignored.
  std::uint64_t answers_outside = 0;
  std::uint64_t commits = 0;
  std::uint64_t chunk_edits_applied = 0;
  std::uint64_t chunk_edits_contained = 0;  // in the snapshot already: dropped
  std::uint64_t chunk_edits_buffered = 0;   // held back for a snapshot
  std::uint64_t patches_applied = 0;        // of veiled sessions
  std::uint64_t buffer_overflows = 0;
  std::uint64_t gaps = 0;
  std::uint64_t requests = 0;         // chunks that were requested, repetitions included
  StackDepths confirmed_stacks;       // edit stacks applied to confirmed runs
  StackDepths predicted_stacks;       // edit stacks applied on top of them
  std::uint64_t digests_checked = 0;  // compared at equal version
  std::uint64_t fell_behind = 0;      // found by two digest checks: a commit was lost
  std::uint64_t drifted = 0;          // digests that differed: a snapshot is requested
  std::uint64_t repaired = 0;         // snapshots that replaced other voxels of their version
  std::uint64_t claims_refuted = 0;   // cached chunks that were not the server's: replaced
  std::uint64_t adopted = 0;          // chunks that came from a cache
  std::uint64_t tiles_adopted = 0;    // tiles that came from a cache
  std::uint64_t tiles_same = 0;       // claimed tiles that the server confirmed
  std::uint64_t claimed = 0;          // chunks that this client claimed to hold
  std::uint64_t same_taken = 0;       // claimed chunks that the server has not modified
  std::uint64_t updates_taken = 0;    // claimed chunks that were completed by the edits they lacked
  /// Chunks newer than what a restarted server is known to have kept.
  std::uint64_t dropped_by_epoch = 0;
};

}  // namespace runstone
