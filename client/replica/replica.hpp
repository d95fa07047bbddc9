// Replica: the client's copy of the chunks in view, always as the runs that arrived, never as a
// grid. Of each chunk it has
//   - the confirmed runs: the last snapshot, and every commit that follows it without a gap;
//   - the shown runs: the confirmed runs with the pending local edits applied by the same
//     apply_stack(). Where nothing is pending they are the same object as the confirmed runs.
//
// How a local edit travels: predict() makes it pending (LocalEdits) and predicts it
// (ChunkUpdater::predict). Its commit confirms it, and each chunk applies it from its inbox and
// drops the prediction. A reject drops the prediction, too. The durable watermark retires it. A new
// connection offers it again if the server lost it.
//
// How a snapshot travels: ChunkUpdater compares its version with the confirmed chunk. It replaces
// the chunk or ignores the snapshot, applies the edits in the inbox that follow, and shows the
// result (ShownRuns), which queues the changed layers (ChangeQueue) for the mesher.
//
// Only versions give the order, so messages of different classes may overtake each other:
//   - An edit of a commit names the sequence that its chunk had before (`previous`). It is applied
//     if the chunk stands there, dropped if the chunk stands at the edit or later, and held back
//     otherwise.
//   - A chunk with a gap, or with a wrong digest, accepts nothing but a snapshot, which it
//     requests.
//   - A snapshot older than the confirmed chunk is ignored.
// An answer to a view is ignored if the chunk has left the view since (RecentViews). Tiles, the
// keys of level 1 or more, are kept apart (FarTiles). They are claimed and cached like chunks, but
// never predicted or requested. After a restart of the server (new epoch) only versions
// that it kept for sure are trusted (SharedHistory).
//
// Pure: no clock and no socket. Times are arguments, in microseconds of the client's steady clock.
// One thread; the chunks that are returned are immutable and may be read from any thread. Bounds:
// chunks by the view; local edits by kLocalEditsMax; commits held back by kInboxEditsMax per chunk,
// and their patches by kPatchSpansMax; claims by kClaimsMax; the cache by kCacheOutboxMax and
// kCacheOutboxBytesMax. MemoryBudget (client/schedule) reduces the view if the chunks take too many
// bytes.
#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "client/far/far_tiles.hpp"
#include "client/replica/cache_outbox.hpp"
#include "client/replica/change_queue.hpp"
#include "client/replica/chunk_updater.hpp"
#include "client/replica/claims.hpp"
#include "client/replica/known_ground.hpp"
#include "client/replica/local_edits.hpp"
#include "client/replica/past_view.hpp"
#include "client/replica/recent_views.hpp"
#include "client/replica/replica_changes.hpp"
#include "client/replica/replica_chunks.hpp"
#include "common/core/result.hpp"
#include "common/edits/descriptor/height_limits.hpp"
#include "common/runs/chunk.hpp"
#include "protocol/codec/messages.hpp"
#include "protocol/rules/edit_check.hpp"

namespace runstone {

/// What the handshake says about the world and about this client.
struct SessionParameters {
  std::int32_t chunk_edge = 32;
  AuthorId author = 0;
  ClientInstance instance = 0;
  Epoch epoch = 0;
  Sequence durable = 0, head = 0;
  ClientSequence resolved = 0;
  std::uint32_t tile_rules = 0;  // SessionAccepted::tile_rules
  bool is_veiled = false;        // the server sends chunks with a veil (docs/veil.md)
  // Of edits. A default EditLimits would know no material but air.
  HeightLimits heights{};
  std::uint64_t edit_volume_max = std::numeric_limits<std::uint64_t>::max();
  std::size_t material_count = std::numeric_limits<std::size_t>::max();

  EditLimits edit_limits() const { return {chunk_edge, material_count, heights, edit_volume_max}; }
};

class Replica {
 public:
  Replica() = default;
  Replica(const Replica&) = delete;
  Replica& operator=(const Replica&) = delete;

  /// Opens a connection: the first one, or another one to the same world. Returns the local edits
  /// to send, in client order. They are found in local_edits().
  std::vector<ClientSequence> open(const SessionParameters& parameters);
  /// Forgets chunks and local edits, because the next connection is to another world.
  void reset();
  bool opened() const { return parameters_.has_value(); }
  /// Returns the limits of an edit of this player. Requires opened().
  EditLimits edit_limits() const {
    EditLimits limits = parameters_->edit_limits();
    limits.volume_max = std::min(limits.volume_max, ground_.edit_volume_max());
    return limits;
  }
  /// Returns 0 before open().
  std::int32_t chunk_edge() const { return parameters_ ? parameters_->chunk_edge : 0; }

  /// Drops the chunks outside of the view. The server is expected to send those inside. The view
  /// has the number with which it is sent; see RecentViews::set().
  void set_view(const View& view);
  const std::optional<View>& view() const { return views_.current(); }

  /// Shows a local edit at once and keeps it until it is durable. `submitted_us`: the click, or the
  /// scheduled time. `in_action`: as in LocalEdits::add(). Fails
  ///   - before open(), and while the past is shown;
  ///   - if the descriptor is invalid, has a material that the world lacks, or exceeds the heights
  ///     or the edit volume of the world;
  ///   - with not_permitted if the player may not make it, as far as this client knows (ground());
  ///   - if it touches an unavailable chunk or more than kTouchedChunksMax chunks;
  ///   - if kLocalEditsMax edits are kept.
  Result<ClientSequence> predict(const EditDescriptor& edit, TimeUs submitted_us, TimeUs now_us,
                                 InAction in_action = {});
  void mark_sent(ClientSequence seq, TimeUs now_us) { local_edits_.mark_sent(seq, now_us); }

  /// Takes snapshots, also of tiles, and completes claimed chunks by the edits that they lack.
  /// Requests a chunk if its edits do not fit.
  void receive(Chunks chunks, const Arrival& arrival);
  /// Takes the answer that claimed chunks are current. Requests those whose claimed copy is not
  /// held any more.
  void receive(const ChunksNotModified& same, TimeUs now_us);
  /// Takes snapshots of one material each.
  void receive(const UniformChunks& uniform, const Arrival& arrival);
  /// Takes the answer that the server cannot send these chunks. Nothing is shown there, and edits
  /// there are refused.
  void receive(const ChunkUnavailable& unavailable);
  /// Fails if the commit is of another epoch, or if a list of previous sequences does not fit its
  /// edit.
  Result<void> receive(const Commit& commit, const Arrival& arrival);
  /// Takes the commit of a veiled session. Fails as receive(Commit) does.
  Result<void> receive(const VeiledCommit& commit, const Arrival& arrival);
  /// Takes what a neighbour that became known uncovers. Fails if the version is of a later epoch.
  Result<void> receive(const VeilPatches& patches, const Arrival& arrival);
  /// `is_offered_again` becomes RejectedEdit::is_offered_again.
  void receive(const Reject& reject, TimeUs now_us, bool is_offered_again = false);
  /// Another server orders the edits from now on. It has resolved those of this client up to
  /// `resolved`. Returns the client sequences of the edits to send again, ascending: those that
  /// have no answer.
  std::vector<ClientSequence> resume(ClientSequence resolved);
  /// Takes the durable watermark. A later epoch begins with it: another server has taken the world
  /// over, with all edits that were ordered before. The watermark of an earlier epoch is ignored.
  void receive(const Durable& durable);
  void receive(const DigestCheck& check, TimeUs now_us);
  /// Allows local edits to use the materials below `count` from now on.
  void set_material_count(std::size_t count) { parameters_->material_count = count; }
  /// Reports that materials got shapes, so that SessionAccepted::tile_rules holds no longer.
  void end_tile_rules() { far_tiles_.end_rules(); }
  void receive(const Permissions& permissions) { ground_.receive(permissions); }
  /// Fails as KnownGround::receive() does.
  Result<void> receive(const ProtectedGround& change) { return ground_.receive(change); }
  /// Announces that the chunks that follow are of another moment; nullopt: of the live world. What
  /// is shown stays until they arrive. In the past nothing is predicted, and commits only resolve
  /// local edits. Back in the live world every chunk is expected again, and pending edits are shown
  /// again.
  void show_moment(const std::optional<PastMoment>& past);
  /// Repeats the requests for chunks that did not arrive within kRequestAgainUs.
  void tick(TimeUs now_us) { updater_.tick(now_us); }

  /// Takes a chunk or tile from a cache: it is shown at once, and claimed. Ignored if one is held,
  /// in the past, and outside of the view. Requires a version that SharedHistory trusts.
  void adopt(const ChunkKey& key, ChunkPtr chunk, TimeUs now_us);
  /// Returns the chunks and tiles to claim before the next view is sent, see Claims::take(). Empty
  /// in the past.
  std::vector<CachedChunk> take_claims();
  /// Returns the chunks of the view that are neither held nor answered for, ascending. A cache may
  /// have them.
  std::vector<ChunkKey> missing() const;
  /// Returns the tiles of the view that a cache may have, see FarTiles::take_not_held().
  std::vector<ChunkKey> take_missing_tiles();
  /// Collects the chunks that leave the view for the cache from now on. A tile that leaves before
  /// it was taken for the cache is not kept.
  void collect_for_cache() { outbox_.enable(); }
  /// Returns at most `count_max` chunks to be cached, see CacheOutbox::take(). Tiles follow.
  std::vector<KeyedChunk> take_for_cache(std::size_t count_max);
  /// Returns true if the last call of take_for_cache() ended a round over all chunks and tiles.
  /// Cost: O(tiles).
  bool is_cache_round_over() const {
    return outbox_.is_round_over() && !far_tiles_.has_for_cache();
  }

  /// Returns what changed since the last call.
  ReplicaChanges drain_changes();
  /// Returns the chunks to request from the server, ascending.
  std::vector<ChunkKey> take_requests() { return updater_.take_requests(); }

  /// Returns nullopt while the live world is shown.
  const std::optional<PastMoment>& past() const { return past_.moment(); }

  /// Return null if nothing is held or shown. The digest of a confirmed chunk is as sent; only a
  /// digest check compares the voxels with the server's digest.
  ChunkPtr confirmed(const ChunkKey& key) const;
  ShownPtr shown(const ChunkKey& key) const;
  /// Returns a number that rises whenever the mesh of the chunk is out of date: when its shown
  /// voxels change, or those of a neighbour at the common border. Returns 0 if nothing is shown.
  std::uint64_t shown_serial(const ChunkKey& key) const;
  /// Returns nullopt if the chunk is not shown.
  std::optional<Material> shown_at(VoxelPos at) const;
  /// Returns the keys of all confirmed chunks, ascending.
  std::vector<ChunkKey> confirmed_keys() const;
  std::size_t confirmed_count() const { return chunks_.confirmed_count(); }
  /// Returns the number of chunks that the server has vouched for on this connection. After a
  /// reconnection the others may lack edits.
  std::size_t current_count() const { return chunks_.vouched_count(); }
  /// Returns the number of chunks for which a snapshot was requested.
  std::size_t awaiting_count() const { return chunks_.awaiting().size(); }
  /// Returns the number of chunks that the server cannot send, by its answers on this connection.
  std::size_t unavailable_count() const { return chunks_.count(ChunkState::unavailable); }
  bool unavailable(const ChunkKey& key) const;
  /// Returns true if the server sends this chunk sooner or later: the view and the world have it,
  /// and it is not unavailable.
  bool is_expected(const ChunkKey& key) const;
  /// Returns the tiles of the view that arrived. While the past is shown, they show it too, once
  /// the server has sent those that differ.
  const FarTiles& far_tiles() const { return far_tiles_; }
  const LocalEdits& local_edits() const { return local_edits_; }
  const KnownGround& ground() const { return ground_; }
  /// Returns the memory of all chunks: confirmed and shown runs, and edits that wait beside them.
  std::size_t chunk_bytes() const { return chunks_.bytes(); }
  Sequence durable() const { return durable_; }
  /// Returns the newest sequence seen in a message of the server.
  Sequence newest() const { return newest_; }
  const ReplicaCounters& counters() const { return counters_; }

 private:
  bool is_in_view(const ChunkKey& key) const { return views_.contains(key); }
  bool accepts(const ChunkKey& key, std::uint32_t view);
  TrackedChunk& track(const ChunkKey& key);
  void receive_tile(ChunkAnswer& answer);
  void receive_snapshot(const ChunkKey& key, Chunk snapshot, TimeUs now_us);
  void receive_missing_edits(const ChunkEdits& edits, TimeUs now_us);
  /// `is_other_kind`: the chunks are held with a veil, and the server sends them without one, or
  /// the other way round.
  void expect_all_chunks(const SharedHistory& history, bool is_other_kind);
  using Touched = std::map<ChunkKey, TrackedChunk*>;
  OrderedPtr ordered_info(const OrderedEdit& ordered, const Version& version,
                          const Arrival& arrival) const;
  bool is_local(const OrderedEdit& ordered) const {
    return ordered.op.author == parameters_->author && ordered.op.instance == parameters_->instance;
  }
  /// Adds an entry to the inbox of a chunk in view. It is applied when all entries have been added.
  void add_to_chunk(const ChunkKey& key, TrackedChunk::InboxEdit entry, Touched& touched);
  Result<void> add_veiled(const VeiledEdit& edit, Epoch epoch, const Arrival& arrival,
                          Touched& touched);
  void advance(const Touched& touched, TimeUs now_us);
  void add_pending_to_chunks(ClientSequence seq);
  Result<void> check(const EditDescriptor& edit) const;
  void confirm_local(ClientSequence seq, const Version& version);
  void retire_durable();

  std::optional<SessionParameters> parameters_;
  RecentViews views_;
  ReplicaChunks chunks_;
  FarTiles far_tiles_;
  PastView past_;
  Claims claims_;
  CacheOutbox outbox_;
  LocalEdits local_edits_;
  KnownGround ground_;
  Sequence durable_ = 0;
  Sequence newest_ = 0;
  bool has_resumed_ = false;  // resume() was called on this connection
  ChangeQueue changes_;
  ReplicaCounters counters_;
  ChunkUpdater updater_{chunks_, changes_, counters_};
};

}  // namespace runstone
