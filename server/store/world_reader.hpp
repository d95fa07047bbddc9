// WorldReader: everything that can be read of a world. A function that needs less takes one of the
// smaller interfaces.
#pragma once
#include <optional>
#include <vector>

#include "server/store/chunk_reader.hpp"
#include "server/store/keyframe.hpp"
#include "server/store/library_reader.hpp"
#include "server/store/log_fold.hpp"
#include "server/store/log_reader.hpp"
#include "server/world/environment/player_rows.hpp"
#include "server/world/environment/saved_state.hpp"

namespace runstone {

class WorldReader : public LogReader, public ChunkReader, public LibraryReader {
 public:
  /// Returns all keyframes, ascending.
  virtual StoreResult<std::vector<Keyframe>> keyframes() = 0;
  /// Returns all chunks that keyframes hold, ascending by sequence.
  virtual StoreResult<std::vector<StoredChunk>> keyframe_chunks() = 0;
  /// Returns the newest stored moment at or before `at`, after a check of its digest. Fails
  /// (bad_request) if the log begins after `at`.
  virtual StoreResult<StoredMoment> stored_moment(Sequence at) = 0;
  /// Returns a chunk of a stored moment, or nullopt if a compaction has removed it since.
  virtual StoreResult<std::optional<Chunk>> load_stored(const StoredChunk& chunk) = 0;
  /// Returns the newest form of a chunk that keyframes hold at or before `at`, or nullopt if there
  /// is none. The keyframe it belongs to may be incomplete: the form is that of its version all the
  /// same. Cost: O(log rows).
  virtual StoreResult<std::optional<Chunk>> load_kept(const ChunkKey& key, Sequence at) = 0;

  /// Returns all players, ascending by author. Fails (corrupt) if a row is damaged or missing.
  virtual StoreResult<std::vector<PlayerRow>> players() = 0;
  /// Returns the last kNamesPerAuthorMax names that each player has used, ascending by author, then
  /// by first use.
  virtual StoreResult<std::vector<UsedName>> player_names() = 0;
  /// Returns the names that keys own, ascending by their folded form. There are none in a world of
  /// format 2 that is open for reading only. Fails (corrupt) if a row is damaged or missing.
  virtual StoreResult<std::vector<NameClaim>> name_claims() = 0;
  /// Returns the watermarks of all client instances. Compactions keep them. Fails (corrupt) if a
  /// row is damaged or missing.
  virtual StoreResult<std::vector<HighWater>> high_waters() = 0;
  /// Returns the highest author number that was ever stored, or 0. It is not lower if rows of
  /// players are lost, so that no number is given to two players.
  virtual AuthorId author_max() const = 0;

  /// Returns the places of players as they were saved last. Fails (corrupt) if they are damaged.
  virtual StoreResult<std::vector<LastPlace>> saved_places() = 0;
  /// Returns the clock as it was set or saved last, or nullopt if it was never set. Fails (corrupt)
  /// if it is damaged.
  virtual StoreResult<std::optional<SavedClock>> saved_clock() = 0;

  /// Returns the error if the world, when it was opened, lacked edits that had been durable, or if
  /// that cannot be known. Returns nullopt if the log is whole.
  virtual const std::optional<StoreError>& loss() const = 0;
  /// Returns false if the connection with the database was lost: every read fails from then on. A
  /// loss is known after the first read that fails.
  virtual bool is_usable() const { return true; }
  /// Returns the volume of the edits up to `last`, and of the keyframes up to there. Cost: O(rows
  /// of keyframes, snapshots and edits with a cause), and some reads of the log.
  virtual StoreResult<LogVolume> log_volume(Sequence /*last*/) { return LogVolume{}; }
  /// Returns the free space inside the file of the world.
  virtual StoreResult<FreeSpace> free_space() { return FreeSpace{}; }
  /// Begins reads that see one moment of the world until end_reads(). Each of them costs less,
  /// because it takes and leaves no lock. Few at a time: meanwhile a server that runs the world
  /// cannot move its write-ahead log into the database. Do not nest them, and write nothing before
  /// end_reads().
  virtual StoreResult<void> begin_reads() = 0;
  virtual StoreResult<void> end_reads() = 0;
  /// Counts the rows that a start does not read otherwise: base chunks, names, keyframes and the log.
  /// Fails (corrupt) if some are missing. Cost: O(rows), without reading them.
  virtual StoreResult<void> check_counts() { return {}; }
  /// Reads and verifies every row of every table but `tile`, which is a cache, and runs the
  /// database's own check. It is slow, and meant for audits. A loss() is no error of a row.
  virtual StoreResult<void> check() = 0;
};

}  // namespace runstone
