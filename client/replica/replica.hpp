// Replica: the client's copy of the chunks in view, always the runs as they came, never a grid.
//   confirmed  what the server said: the last snapshot and every commit that follows it without a gap
//   shown      confirmed plus our own edits that the server has not answered yet (the pending stack), by
//              the same apply_stack(); the very same object as confirmed where nothing is pending
// Order comes from versions alone, so messages of different classes may overtake each other:
//   - an edit of a commit names the sequence its chunk stood at before (`previous`): it is applied if the
//     chunk stands there, dropped if the chunk already stands at the edit or later, and held back otherwise;
//   - a chunk with a gap, or whose digest an audit found wrong, takes nothing but a snapshot that it
//     asks for;
//   - a snapshot older than what is held is ignored.
// After a restart of the server (new epoch) everything newer than what it kept on disk is distrusted, and own
// edits it lost are offered again; operation ids make that exactly-once. A server whose log ends before what
// was durable here stands on a restored backup: then every edited chunk is distrusted. Pure: no clock, no
// socket; times are arguments (microseconds of the client's steady clock). One thread; the chunks handed out
// are immutable and may be read from anywhere. Bounds: chunks, by the view; own edits, kLocalEditsMax (full:
// submit() refuses); commits held back, kInboxEditsMax a chunk (full: they are dropped and the chunk asks for
// a snapshot that contains them).
#pragma once
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "client/replica/change_queue.hpp"
#include "client/replica/kept_versions.hpp"
#include "client/replica/local_edits.hpp"
#include "client/replica/replica_changes.hpp"
#include "client/replica/tracked_chunk.hpp"
#include "common/core/result.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/descriptor/height_limits.hpp"
#include "common/runs/chunk.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

inline constexpr std::size_t kInboxEditsMax = 1024;  // edits held back per chunk
inline constexpr TimeUs kRequestAgainUs =
    2'000'000;  // a chunk asked for is asked for again after this

/// Claims that wait for an answer: half of what a server takes, so that those for the next view fit beside them.
inline constexpr std::size_t kClaimsMax = kClaimsPerSessionMax / 2;
inline constexpr std::size_t kLeftMax =
    32'768;  // chunks that left the view and wait to be kept; others are forgotten

/// What welcome and ready say about the world and about us.
struct SessionParameters {
  std::int32_t chunk_edge = 32;
  AuthorId author = 0;
  ClientInstance instance = 0;
  Epoch epoch = 0;
  Sequence durable = 0, head = 0;
  ClientSequence resolved = 0;
  HeightLimits heights{};                                                     // of edits
  std::uint64_t edit_volume_max = std::numeric_limits<std::uint64_t>::max();  // voxels per edit
};

/// A moment of the past that a replica shows.
struct PastMoment {
  Sequence seq = 0;   // its last edit; 0: before the first one
  TimeUs utc_us = 0;  // when that was ordered
};

class Replica {
 public:
  /// A connection opens: the first one, or a resumption of the same world. Returns the own edits to send
  /// (again), in client order; find them in local_edits().
  std::vector<ClientSequence> open(const SessionParameters& opening);
  /// Forgets chunks and own edits: another world.
  void reset();
  bool opened() const { return opening_.has_value(); }
  std::int32_t chunk_edge() const { return opening_ ? opening_->chunk_edge : 0; }

  /// Chunks outside leave at once; those inside are expected from the server.
  void set_view(const View& view);
  const std::optional<View>& view() const { return view_; }

  /// Shows an own edit at once and keeps it until it is durable. `submitted_us`: the click, or the scheduled
  /// time. Fails in the past, on an invalid descriptor, beyond the world's heights or volume, on an unavailable chunk,
  /// before the first opening, and when kLocalEditsMax are held.
  Result<ClientSequence> submit(const EditDescriptor& edit, TimeUs submitted_us, TimeUs now_us);
  void mark_sent(ClientSequence seq, TimeUs now_us);

  void receive(ChunkSnapshot snapshot, const Arrival& arrival);
  /// Claimed chunks are current as they are; where it is not the copy that is held now, the chunk is asked for.
  void receive(const ChunksNotModified& same, TimeUs now_us);
  /// As a snapshot at `edits.to`, made of what is held. Asks for the chunk if the two do not fit each other.
  void receive(const ChunkEdits& edits, const Arrival& arrival);
  /// Snapshots of one material each.
  void receive(const UniformChunks& uniform, const Arrival& arrival);
  /// The server cannot send these chunks: nothing is shown there, and own edits there are refused.
  void receive(const ChunkUnavailable& unavailable);
  /// Fails if the commit contradicts itself (a list of previous sequences that does not fit its edit).
  Result<void> receive(const Commit& commit, const Arrival& arrival);
  void receive(const Reject& reject, TimeUs now_us);
  void receive(const Durable& durable);
  void receive(const DigestCheck& audit, TimeUs now_us);
  /// From here on the chunks are those of another moment: what is shown stays until they come. In the past nothing is
  /// predicted and no commit is applied, but for the fate of own edits. Back in the live world all is as after a
  /// resumption, and own edits that wait are shown again.
  void begin_moment(const std::optional<PastMoment>& past);
  /// Asks again for chunks that were asked for kRequestAgainUs ago and have not come.
  void tick(TimeUs now_us);

  /// A chunk of the view from a cache: shown at once, and to be claimed. Ignored where a chunk is held, in the past, and
  /// outside of the view. Its version must be one that KeptVersions trusts.
  void adopt(const ChunkKey& key, ChunkPtr chunk, TimeUs now_us);
  /// What is held without the server knowing it, ascending: to be claimed before the next view. No chunk twice on a
  /// connection, and no more than kClaimsMax that wait for an answer. The digests are those of the runs, recomputed:
  /// so a copy that has drifted is found out. O(runs).
  std::vector<CachedChunk> take_claims();
  /// Chunks of the view that are neither held nor answered, ascending: a cache may have them.
  std::vector<ChunkKey> missing() const;
  /// From now on chunks that leave the view wait for take_unkept().
  void keep_chunks() { keeps_ = true; }
  /// Chunks to be kept for later, `count_max` at most: those that left the view, then those that are not as
  /// they were when they were last taken. Only what the server vouches for on this connection.
  std::vector<std::pair<ChunkKey, ChunkPtr>> take_unkept(std::size_t count_max);

  /// What changed since the last call.
  ReplicaChanges drain_changes() { return news_.take(); }
  /// Chunks to ask the server for, ascending.
  std::vector<ChunkKey> take_requests();

  /// Nothing: the live world.
  const std::optional<PastMoment>& past() const { return past_; }

  /// Null if not held.
  ChunkPtr confirmed(const ChunkKey& key) const;
  ShownPtr shown(const ChunkKey& key) const;
  /// Rises with every change of the chunk's picture: of its shown voxels, or of a neighbour's at the common
  /// border. 0 if nothing is shown.
  std::uint64_t shown_serial(const ChunkKey& key) const;
  /// Empty if the chunk is not shown.
  std::optional<Material> shown_at(VoxelPos at) const;
  /// Keys of all confirmed chunks, ascending.
  std::vector<ChunkKey> confirmed_keys() const;
  std::size_t confirmed_count() const { return confirmed_count_; }
  /// Chunks whose snapshot came on this connection: after a resumption the others may have missed edits.
  std::size_t current_count() const { return current_count_; }
  /// Chunks that wait for a snapshot they asked for.
  std::size_t awaiting_count() const { return awaiting_.size(); }
  /// Chunks that the server said on this connection it cannot send.
  std::size_t unavailable_count() const { return unavailable_count_; }
  bool unavailable(const ChunkKey& key) const {
    const TrackedChunk* chunk = find(key);
    return chunk != nullptr && chunk->unavailable;
  }
  const LocalEdits& local_edits() const { return own_; }
  Sequence durable() const { return durable_; }
  /// Newest sequence seen in a commit or a welcome.
  Sequence newest() const { return newest_; }
  const ReplicaCounters& counters() const { return counters_; }

 private:
  TrackedChunk& track(const ChunkKey& key);
  TrackedChunk* find(const ChunkKey& key);
  const TrackedChunk* find(const ChunkKey& key) const;
  void settle(const ChunkKey& key, TrackedChunk& chunk, bool from_snapshot, TimeUs now_us);
  void settle_own();
  void set_awaiting(const ChunkKey& key, TrackedChunk& chunk, bool awaiting);
  void request(const ChunkKey& key, TrackedChunk& chunk, TimeUs now_us);
  void show(const ChunkKey& key, TrackedChunk& chunk, ShownPtr next,
            std::span<EditNews* const> cause);
  void border_changed(const ChunkKey& key, Direction side, const DirtyLayers& dirty,
                      std::span<EditNews* const> cause);
  void show_predicted(const ChunkKey& key, TrackedChunk& chunk, std::span<EditNews* const> cause);
  void vouched_for(const ChunkKey& key, TrackedChunk& chunk, TimeUs now_us);
  void set_current(TrackedChunk& chunk);
  bool is_own(const OperationId& op) const;
  VoxelPos origin(const ChunkKey& key) const { return origin_of(key.at, opening_->chunk_edge); }

  std::optional<SessionParameters> opening_;
  std::optional<View> view_;
  std::optional<PastMoment> past_;
  std::map<ChunkKey, TrackedChunk> chunks_;
  std::set<ChunkKey> awaiting_;  // looked at every turn, and so not searched for in the whole view
  std::size_t confirmed_count_ = 0;
  std::size_t current_count_ = 0;
  std::size_t unavailable_count_ = 0;
  LocalEdits own_;
  Sequence durable_ = 0;
  Sequence newest_ = 0;
  std::uint64_t last_serial_ = 0;
  ApplyScratch scratch_;
  ReplicaCounters counters_;

  ChangeQueue news_;
  bool keeps_ = false;
  std::vector<std::pair<ChunkKey, ChunkPtr>> left_;  // the view, to be kept; kLeftMax at most
  std::vector<ChunkKey> requests_;
};

}  // namespace runstone
