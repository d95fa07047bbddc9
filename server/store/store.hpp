// Store: the world on disk: base, one edit log, snapshots, keyframes, players, meta (docs/edit-log.md gives the schema).
// The interface is what the log writer, the loader, replay and import need; SQLite implements it, another
// database may later. It blocks on the disk, so the world strand never calls it: one writer thread owns a
// Store, and readers open their own. Rules that keep a world safe:
//   - append() returns after the data is on disk (WAL, synchronous FULL): what it took is durable;
//   - a snapshot may only be saved at a version <= the last durable sequence;
//   - a row that does not decode or whose checksum is wrong is an error that names file, table and row. It is
//     never overwritten, regenerated or skipped in silence.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_record.hpp"
#include "common/generate/generator.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/chunk.hpp"
#include "protocol/codec/messages.hpp"
#include "server/store/log_query.hpp"
#include "server/world/player_rows.hpp"

namespace runstone {

inline constexpr std::uint32_t kStoreFormatVersion = 4;

struct StoreError {
  enum class Kind {
    io,
    not_a_world,
    newer_version,
    corrupt,
    exists,
    full,
    bad_request,
    locked,
    cancelled
  };
  Kind kind = Kind::io;
  std::string file;  // the database
  std::string
      where;  // table and row, e.g. "edit_log seq=9120" or "snapshot chunk=1,0,-3"; may be empty
  std::string what;
  std::string message() const;  // one line: "FILE: WHERE: WHAT"
};
template <class T>
using StoreResult = Result<T, StoreError>;

/// What `meta` pins when a world is created. None of it changes afterwards.
struct WorldMeta {
  WorldId world_id{};
  std::uint16_t chunk_edge = 32;
  GeneratorPin generator;
  MaterialTable materials;
  std::array<std::uint8_t, 32> server_key_seed{};  // Ed25519 identity of this world's server
  WorldPos spawn;
};

/// A place in the log: (0, 0) and 0 before the first edit.
struct LogEnd {
  Version version;
  TimeUs time_us = 0;  // UTC, of that edit
  friend bool operator==(const LogEnd&, const LogEnd&) = default;
};

/// What the log holds: edits first .. last.version.seq, none if `first` lies behind it. Edits before `first`
/// were compacted: they are in the base alone.
struct LogRange {
  Sequence first = 1;
  LogEnd last;  // the last edit ever ordered, compacted or not
  friend bool operator==(const LogRange&, const LogRange&) = default;
};

/// A moment of which all chunks are kept, so that no edit before it need be read to know the world there.
struct Keyframe {
  LogEnd at;                 // the last edit in it
  std::uint64_t chunks = 0;  // edited up to there
  Digest world_digest;       // over them
  friend bool operator==(const Keyframe&, const Keyframe&) = default;
};

/// A chunk that is kept as an edit left it, without its voxels.
struct StoredChunk {
  ChunkKey key;
  Version version;
  Digest digest;
  bool is_base = false;  // in the base: completed by a compaction; else a keyframe's
  friend bool operator==(const StoredChunk&, const StoredChunk&) = default;
};

/// A moment that needs no edits to be known: a keyframe, or the head of the log.
struct StoredMoment {
  LogEnd at;
  std::vector<StoredChunk> chunks;  // all that were edited up to there, ascending by key
};

class Store {
 public:
  virtual ~Store() = default;

  virtual const WorldMeta& meta() const = 0;
  virtual const std::string& file() const = 0;

  // ---- start
  // -----------------------------------------------------------------------------------------------
  /// Raises the epoch by one and returns it, durably. Called once per server start.
  virtual StoreResult<Epoch> raise_epoch() = 0;
  /// Epoch of the last start (0: never started).
  virtual Epoch epoch() const = 0;
  /// What the log holds and where it ends. All of it is durable.
  virtual StoreResult<LogRange> log_range() = 0;
  /// The last edit that was compacted away: the log begins behind it. (0, 0) and 0 if none was.
  virtual StoreResult<LogEnd> log_head() = 0;
  /// Whether there are base chunks: imported, or completed by a compaction.
  virtual StoreResult<bool> has_base() = 0;
  /// Last sequence ever logged (0: none), compacted or not.
  virtual StoreResult<Sequence> last_sequence() = 0;
  /// Every edit up to here is contained in a snapshot of each chunk it touched (0: none).
  virtual StoreResult<Sequence> checkpoint() = 0;
  virtual StoreResult<std::vector<PlayerRow>> players() = 0;
  virtual StoreResult<std::vector<HighWater>> high_waters() = 0;

  // ---- writing
  // -----------------------------------------------------------------------------------------------
  /// One transaction: new players, then records, then the high-water marks they imply. Durable on return.
  /// Records must continue the log without a gap, and their numbers must be those of a record
  /// (validate_numbers()); nothing is written otherwise (bad_request).
  virtual StoreResult<void> append(std::span<const PlayerRow> players,
                                   std::span<const EditRecord> records) = 0;
  /// Import only: as append(), for what another copy of this world logged. Each record keeps its epoch, which may
  /// not be older than that of the one before it; the world's epoch rises to the newest.
  virtual StoreResult<void> append_history(std::span<const PlayerRow> players,
                                           std::span<const EditRecord> records) = 0;
  /// Replaces the snapshots of these chunks and, if given, moves the checkpoint, in one transaction.
  virtual StoreResult<void> save_snapshots(std::span<const std::pair<ChunkKey, ChunkPtr>> chunks,
                                           std::optional<Sequence> checkpoint) = 0;
  /// Adds chunks as edits of the log left them and, if given, the keyframe that they complete, in one transaction. Refuses
  /// (bad_request) a keyframe that the chunks of base and keyframes do not prove. A chunk that is there already stays.
  virtual StoreResult<void> save_keyframe(std::span<const std::pair<ChunkKey, ChunkPtr>> chunks,
                                          const std::optional<Keyframe>& keyframe) = 0;
  /// Takes all edits up to a keyframe into the base and deletes them, their indexes, the keyframe and those before it, in one
  /// transaction: completes the base from the keyframe, moves the head of the log, and the checkpoint if it lies before; a chunk whose snapshot is
  /// older than the base gets one that is not. Marks of players stay. While no server runs the world.
  virtual StoreResult<void> compact(Sequence keyframe) = 0;
  /// Gives the free space in the database back to the file system. Needs room for a second copy meanwhile.
  virtual StoreResult<void> shrink() = 0;
  /// Import only, while nothing was ever logged: base chunks at version (0, 0).
  virtual StoreResult<void> save_base(std::span<const std::pair<ChunkKey, ChunkPtr>> chunks) = 0;

  // ---- reading
  // -----------------------------------------------------------------------------------------------
  virtual StoreResult<std::optional<Chunk>> load_snapshot(const ChunkKey& key) = 0;
  virtual StoreResult<std::optional<Chunk>> load_base(const ChunkKey& key) = 0;
  /// The last edit not later than a time (UTC): where the log stood then. The sequence before the first edit of the log if all are
  /// later; then fails (bad_request) if something was compacted away that is later too.
  virtual StoreResult<Sequence> sequence_at(TimeUs time_us) = 0;
  /// All base chunks, imported or completed, ascending by key, as the fold in `meta` has them.
  virtual StoreResult<std::vector<StoredChunk>> base_chunks() = 0;
  /// All chunks that keyframes hold, ascending by sequence.
  virtual StoreResult<std::vector<StoredChunk>> keyframe_chunks() = 0;
  /// All keyframes, ascending. None in a world of an older format that is open for reading only.
  virtual StoreResult<std::vector<Keyframe>> keyframes() = 0;
  /// The newest stored moment at or before `at`, proved by its digest. Fails (bad_request) if the log begins behind `at`.
  virtual StoreResult<StoredMoment> stored_moment(Sequence at) = 0;
  /// The voxels of a chunk of a stored moment; nothing if a compaction has taken them away since.
  virtual StoreResult<std::optional<Chunk>> load_stored(const StoredChunk& chunk) = 0;
  /// The newest form of one chunk that keyframes hold at or before `at`, as the edit of its version left it; no moment
  /// need be complete for that. Nothing if there is none. O(log rows).
  virtual StoreResult<std::optional<Chunk>> load_kept(const ChunkKey& key, Sequence at) = 0;
  /// Calls `each` for records first..last (both included) in order; stops early when it returns false. What
  /// lies outside log_range() is left out.
  /// Each record's checksum is verified and the sequence checked to be without gaps.
  virtual StoreResult<void> read_log(Sequence first, Sequence last,
                                     const std::function<bool(const EditRecord&)>& each) = 0;
  /// Calls `each` for the records that answer the query, in order; stops early when it returns false. Fails
  /// (bad_request) in a world of format 1 that is open for reading only: it has no indexes yet.
  virtual StoreResult<void> query_log(const LogQuery& query,
                                      const std::function<bool(const EditRecord&)>& each) = 0;
  /// Keys and versions of all snapshots, ascending.
  virtual StoreResult<std::vector<std::pair<ChunkKey, Version>>> snapshot_keys() = 0;

  /// Reads and verifies every row of every table, and runs the database's own check. Slow: for audits.
  virtual StoreResult<void> check() = 0;
};

/// A world is a folder that holds `world.sqlite`; the folder is made if need be. Refuses a folder that
/// already holds one. The new world is open for writing.
StoreResult<std::unique_ptr<Store>> create_world(const std::string& folder, const WorldMeta& meta,
                                                 const std::string& vfs = "");

enum class StoreAccess { read_only, read_write };
/// Opens an existing world; a lock refuses a second writer. `vfs`: SQLite VFS name, for tests; empty for the
/// default.
StoreResult<std::unique_ptr<Store>> open_world(const std::string& folder, StoreAccess access,
                                               const std::string& vfs = "");

}  // namespace runstone
