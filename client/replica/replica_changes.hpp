// ReplicaChanges: what changed in a replica since it was last asked, for the mesher, the latency recorder and
// the UI.
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

/// When a message came in, on the client's steady clock.
struct Arrival {
  TimeUs received_us = 0;  // its last byte was read from the socket
  TimeUs unpacked_us = 0;  // it was decoded and verified
  TimeUs now_us = 0;       // the replica takes it: "applied"
};

inline constexpr TimeUs kTimeUnknown = -1;

/// The layers of a chunk's picture that changed, as mesh_rdm_layers() wants them.
struct VisibleLayers {
  DirtyLayers dirty;  // in which a shown voxel changed
  /// By Direction, the same of each neighbour that changed in the layer that touches this chunk: all its
  /// layers. Empty where that layer stayed as it was.
  std::array<DirtyLayers, kDirectionCount> beyond;
  VisibleLayers& operator|=(const VisibleLayers& other) {
    dirty |= other.dirty;
    for (std::size_t d = 0; d < beyond.size(); ++d) beyond[d] |= other.beyond[d];
    return *this;
  }
  friend bool operator==(const VisibleLayers&, const VisibleLayers&) = default;
};

/// One chunk whose picture changed. Changes of a chunk are joined until they are taken.
struct ChunkNews {
  ChunkKey key;
  std::uint64_t serial = 0;  // of the picture, see Replica::shown_serial()
  VisibleLayers layers;      // all that changed, but for neighbours that came or left the view
  bool whole = false;        // nothing was shown here before, or nothing in between
  bool removed = false;      // out of view or unavailable: nothing is shown here
  std::vector<OperationId>
      edits;  // edits that this change contains, in the order they were applied
};

/// One edit that reached the replica: its prediction, or its place in the confirmed order.
struct EditNews {
  OperationId op;
  Sequence seq = 0;        // 0 for a prediction
  Sequence subject = 0;    // the earlier edit that this one answers (rollback, undo, redo); 0: none
  bool own = false;        // made by this client instance
  bool predicted = false;  // shown ahead of the server's answer
  bool in_snapshot = false;  // came with a snapshot after its commit had been held back
  TimeUs submitted_us = 0;   // server steady clock, as sent; 0 unknown; unused for predictions
  TimeUs ordered_us = 0;     // server steady clock; unused for predictions
  TimeUs received_us = 0;    // this client's steady clock; so are the next two
  TimeUs unpacked_us = 0;
  TimeUs applied_us = 0;
  /// Chunks to mesh again because of it, neighbours at a border included; empty: nothing visible changed.
  std::vector<ChunkKey> chunks;
};

/// The server refused one of our edits; its prediction is gone.
struct RejectNews {
  ClientSequence seq = 0;
  RejectReason reason = RejectReason::busy;
  std::string detail;
};

/// The server cannot send a chunk of the view.
struct UnavailableNews {
  ChunkKey key;
  UnavailableReason reason = UnavailableReason::damaged;
};

struct ReplicaChanges {
  std::vector<ChunkNews> chunks;  // ascending by key
  std::vector<EditNews> edits;    // in the order applied
  std::vector<RejectNews> rejects;
  std::vector<ClientSequence> durable;  // own edits now known to be on disk
  /// Own edits that were decided while we could not listen, by a server that no longer knows how: applied and
  /// durable, or refused. The chunks tell.
  std::vector<ClientSequence> unseen;
  /// Chunks that the server cannot send, and why.
  std::vector<UnavailableNews> unavailable;
};

/// Counts since the replica was made. `chunk edits` count an edit once per chunk.
struct ReplicaCounters {
  std::uint64_t snapshots_taken = 0;    // became the confirmed chunk
  std::uint64_t snapshots_stale = 0;    // older than what we hold: ignored
  std::uint64_t snapshots_outside = 0;  // not in view: ignored
  std::uint64_t commits = 0;
  std::uint64_t chunk_edits_applied = 0;
  std::uint64_t chunk_edits_contained = 0;  // already in the snapshot: dropped
  std::uint64_t chunk_edits_buffered = 0;   // came ahead of their snapshot
  std::uint64_t buffer_overflows = 0;
  std::uint64_t gaps = 0;
  std::uint64_t requests = 0;                      // chunks asked for again
  StackDepths confirmed_stacks, predicted_stacks;  // applied to confirmed runs, and on top of them
  std::uint64_t audited = 0;                       // compared at equal version
  std::uint64_t fell_behind = 0;     // by two audits: a commit got lost; repaired likewise
  std::uint64_t drifted = 0;         // and found different: a snapshot is asked for
  std::uint64_t repaired = 0;        // a snapshot replaced other voxels of its version
  std::uint64_t claims_refuted = 0;  // kept copies that were not the server's: replaced
  std::uint64_t adopted = 0;         // chunks that a cache had
  std::uint64_t claimed = 0;         // chunks that the server was told are held
  std::uint64_t same_taken = 0;      // they are as the server has them
  std::uint64_t updates_taken = 0;   // brought up to date by the edits they lacked
  std::uint64_t own_submitted = 0;
  std::uint64_t own_confirmed = 0;
  std::uint64_t own_rejected = 0;
  std::uint64_t own_durable = 0;
  std::uint64_t own_offered_again = 0;
  std::uint64_t dropped_by_epoch = 0;  // chunks newer than what a restarted server kept
};

}  // namespace runstone
