// Store: a world on disk: base, one edit log, snapshots, keyframes, players, meta. docs/edit-log.md
// gives the schema. It is the union of small interfaces, one for each use:
//   - WorldReader reads. A function that needs less takes a LogReader or a ChunkReader;
//   - WorldSink is what the log writer of a running server calls;
//   - ImportSink fills a new world.
// SqlStore implements it on SQLite and on PostgreSQL. Every call blocks on the disk or the network,
// so the world strand makes none: one writer thread owns a Store, and readers open their own. These
// rules keep a world safe:
//   - append() returns after the data is on disk: what it has written is durable;
//   - a snapshot may only be saved at a version that is durable;
//   - a row that does not decode, or whose checksum is wrong, is an error that names file, table
//     and row. It is never overwritten, regenerated or skipped. Tiles are the exception, because
//     they are a cache: a damaged tile is made of its chunks again.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/store/lease_terms.hpp"
#include "server/store/world_reader.hpp"
#include "server/store/world_sink.hpp"

namespace runstone {

class ImportSink {
 public:
  virtual ~ImportSink() = default;

  /// Writes base chunks at version (0, 0). Fails (bad_request) once an edit was logged.
  virtual StoreResult<void> save_base(ChunkSpan chunks) = 0;
  /// Writes what another copy of this world logged, as WorldSink::append(). Each record keeps its
  /// epoch, which may not be older than that of the record before it. The world's epoch rises to
  /// the newest.
  virtual StoreResult<void> append_history(std::span<const PlayerRow> players,
                                           std::span<const EditRecord> records) = 0;
};

class Store : public WorldReader, public WorldSink, public ImportSink {
 public:
  /// Raises the epoch by one and returns it. It is durable on return. A server calls it once per
  /// start.
  virtual StoreResult<Epoch> raise_epoch() = 0;
  /// Raises the epoch to the first one of a new branch (common/core/epoch_branch.hpp) and returns
  /// it. It is durable on return. A copy of a world begins with it, because its log and that of the
  /// original go on with different edits. `now_us` is the time in UTC.
  virtual StoreResult<Epoch> begin_branch(TimeUs now_us) = 0;
  /// Returns the epoch of the last start, or 0 if the world was never started. It is not lower if
  /// that start is lost.
  virtual Epoch epoch() const = 0;
  /// Makes a world usable that has lost edits, players or watermarks. Requires StoreAccess::repair.
  /// Returns a line for each loss; there are none if nothing is lost. Deletes all tiles, because a
  /// tile may contain lost edits.
  ///   - Lost edits: the world stays as the rest of the log makes it. The epoch becomes that of a
  ///     new branch, and the next raise_epoch() ends the loss. In PostgreSQL it does so in any
  ///     case, because nobody notices that a database was put back from a backup.
  ///   - Lost players: the rest is counted anew. Their numbers are not given again.
  ///   - Lost watermarks: those of edits in the log are made again, and all are counted anew.
  virtual StoreResult<std::vector<std::string>> accept_losses() = 0;
  /// Moves all edits up to a keyframe into the base, in one transaction. Requires that no server
  /// runs the world.
  ///   - The base is completed from the keyframe.
  ///   - The edits, their indexes, the keyframe and those before it are deleted. Changes of rights
  ///     and textures move to a table of their own, new materials to the material table of `meta`.
  ///   - The head of the log moves, and so does the checkpoint if it lies before the head.
  ///   - A chunk whose snapshot is older than the base gets a snapshot that is not. Tiles above it
  ///     that are older are deleted.
  ///   - The watermarks of players stay.
  virtual StoreResult<void> compact(Sequence keyframe) = 0;
  /// Returns keys of chunks in one of the two tables, ascending: those behind `behind`, or the
  /// first ones if that is nullopt, `count` at most. It reads no voxels. A running server may add
  /// rows before `behind` meanwhile. Fails (corrupt) for a key that no chunk can have. Cost: O(log
  /// rows + count).
  enum class ChunkRows { base, snapshot };
  virtual StoreResult<std::vector<ChunkKey>> chunk_keys(ChunkRows rows,
                                                        const std::optional<ChunkKey>& behind,
                                                        std::size_t count) = 0;
  /// Moves all of the world into its main file, which can be copied alone until the next write.
  /// Fails (locked) if a reader keeps it from doing so. The destructor does the same and says
  /// nothing.
  virtual StoreResult<void> complete_file() { return {}; }
  /// Returns the free space in the database to the file system. Requires disk space for a second
  /// copy meanwhile.
  virtual StoreResult<void> shrink() = 0;
};

// A place is a folder, for a world in an SQLite file, or the address of a PostgreSQL database:
// postgresql://... (place_rule.hpp)
bool is_database(const std::string& place);
/// Returns the place for messages. It has no password.
std::string place_name(const std::string& place);

/// Creates a world and opens it for writing. A folder is made if it does not exist. Fails if the
/// place holds a world already. `lease` matters for a database only.
StoreResult<std::unique_ptr<Store>> create_world(const std::string& place, const WorldMeta& meta,
                                                 const std::string& vfs = "",
                                                 const LeaseTerms& lease = {});

enum class StoreAccess {
  read_only,
  read_write,  // fails with the error of loss() if the world has one, and changes no file
  repair       // writes, also if the world has a loss
};
/// Opens an existing world. Fails (locked) if another program has it open for writing, and `access`
/// is not read_only; if that program has ended without giving the lease of a database back, waits
/// until the lease has run out. `vfs` is the name of an SQLite VFS, for tests; an empty name means
/// the default one.
StoreResult<std::unique_ptr<Store>> open_world(const std::string& place, StoreAccess access,
                                               const std::string& vfs = "",
                                               const LeaseTerms& lease = {});

}  // namespace runstone
