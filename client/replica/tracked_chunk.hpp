// TrackedChunk: everything that a replica knows about one chunk:
//   - the confirmed runs and the shown runs;
//   - the pending edits: local edits that the confirmed runs do not contain yet;
//   - the inbox: ordered edits that arrived before the edits or the snapshot that they follow.
// The state and the confirmed chunk are changed by ReplicaChunks only, which counts them. One
// thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "client/replica/chunk_state.hpp"
#include "common/core/ids.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/runs/chunk.hpp"
#include "common/veil/veil_patch.hpp"

namespace runstone {

using ShownPtr = std::shared_ptr<const RunChunk>;

/// What all chunks of one ordered edit share.
struct OrderedInfo {
  OperationId op;
  Version version;
  EditDescriptor edit;
  Sequence subject = 0;                     // as in OrderedEdit
  bool is_local = false;                    // made by this client instance
  TimeUs submitted_us = 0, ordered_us = 0;  // the server's steady clock
  TimeUs received_us = 0, unpacked_us = 0;  // this client's steady clock
};
using OrderedPtr = std::shared_ptr<const OrderedInfo>;

inline constexpr std::size_t kRepeatedPatchesMax = 64;
/// Spans of all patches that wait in the inbox of a chunk, and of all patches that the chunk may
/// repeat. A span takes 12 bytes in memory and only 2 in a message.
inline constexpr std::size_t kPatchSpansMax = 65'536;

class TrackedChunk {
 public:
  explicit TrackedChunk(const ChunkKey& chunk_key) : key(chunk_key) {}

  /// An ordered edit, or a patch of a veiled session, that waits until what precedes it has been
  /// applied.
  struct InboxEdit {
    OrderedPtr info;                                   // null for a patch that no edit has caused
    Sequence previous = 0;                             // the chunk's sequence before it
    Version version;                                   // the chunk's version behind it
    bool has_edit = true;                              // false: only the patch is applied
    std::shared_ptr<const VeilPatch> patch = nullptr;  // applied behind the edit; null: none
    /// Returns true if the patch leaves the version as it is. It may be applied again.
    bool is_repeatable() const { return !has_edit && previous == version.seq; }
  };
  /// Returns the number of spans of all patches of these entries.
  static std::size_t span_count(std::span<const InboxEdit> entries);
  /// A local edit that the confirmed runs do not contain yet.
  struct PendingEdit {
    ClientSequence seq = 0;
    EditDescriptor edit;
    Sequence confirmed_at = 0;  // sequence of its commit; 0: none has arrived
    /// Its answer was missed. The next snapshot contains or excludes the edit.
    bool until_snapshot = false;
  };

  const ChunkKey key;
  ShownPtr shown;                    // null if nothing is shown
  std::uint64_t serial = 0;          // see Replica::shown_serial()
  std::vector<PendingEdit> pending;  // ascending by seq
  std::vector<InboxEdit> inbox;      // ascending by sequence
  /// Patches that were applied at the confirmed version and did not move it. A snapshot of the same
  /// version may lack them. At most kRepeatedPatchesMax, with kPatchSpansMax spans. A digest check
  /// finds a patch that is missing.
  std::vector<InboxEdit> repeatable;
  Sequence latest = 0;  // newest edit of this chunk seen on this connection
  /// Newest version above the confirmed one that a digest check named on this connection.
  Version behind_of;
  std::optional<TimeUs> requested_us;  // last request for a snapshot
  /// Version that was last handed to the cache, or that came from it.
  std::optional<Version> cached;

  ChunkState state() const { return state_; }
  bool is_current() const { return state_ == ChunkState::current; }
  bool is_unavailable() const { return state_ == ChunkState::unavailable; }
  /// Returns null if nothing is held: before the first snapshot or cached copy, while the chunk is
  /// unavailable, and after a restart of the server that may have lost this version.
  const ChunkPtr& confirmed() const { return confirmed_; }
  /// Returns true if the server vouches for the confirmed chunk and the cache does not have this
  /// version.
  bool is_for_cache() const { return is_current() && confirmed_ && cached != confirmed_->version; }

  /// Adds a local edit to the pending edits, in client order, unless it is there.
  void add_pending(ClientSequence seq, const EditDescriptor& edit);
  /// Returns false if the edit is not pending here.
  bool drop_pending(ClientSequence seq);
  /// Notes the commit of a pending edit. Does nothing if the edit is not pending here.
  void confirm_pending(ClientSequence seq, Sequence at);
  /// Leaves a pending edit to the next snapshot. Does nothing if the edit is not pending here.
  void leave_to_snapshot(ClientSequence seq);
  /// Drops the pending edits that a snapshot at `seq` contains or excludes for sure. Returns how
  /// many.
  std::size_t drop_answered(Sequence seq);

  /// Puts the patches of this version back into the inbox, because a snapshot may lack them.
  void repeat_patches(const Version& version);

  /// What take_ready_edits() took from the inbox.
  struct ReadyEdits {
    struct Patch {
      std::size_t edits = 0;  // of `stack`, which precede the patch
      std::shared_ptr<const VeilPatch> patch;
    };
    std::vector<EditDescriptor> stack;  // to be applied to the confirmed runs
    std::vector<Patch> patches;         // to be applied between the edits of `stack`
    std::vector<OrderedPtr> applied;    // the edits of `stack` and `patches`, with their order
    std::vector<OrderedPtr> contained;  // the confirmed runs contain them already
    Version version;                    // after the stack
  };
  /// Takes edits from the front of the inbox until one does not follow the version reached. Local
  /// edits among them are no longer pending. Requires confirmed().
  ReadyEdits take_ready_edits();

  /// Returns the runs to show: those of the confirmed chunk itself if nothing is pending, otherwise
  /// a copy with the pending edits applied. Requires confirmed().
  ShownPtr predicted(ApplyScratch& scratch) const;

  /// Returns the memory of the chunk: its runs, and what is kept beside them. Runs that are
  /// confirmed and shown count once. Cost: O(edits in the inbox + pending edits).
  std::size_t bytes() const;

  /// Returns the world position of the first voxel of `voxels`, which are runs of this chunk.
  VoxelPos origin(const RunChunk& voxels) const;

 private:
  friend class ReplicaChunks;
  ChunkState state_ = ChunkState::expected;
  ChunkPtr confirmed_;
  std::size_t counted_bytes_ = 0;  // of bytes(), in ReplicaChunks::bytes()
};

}  // namespace runstone
