// WorldSink: the writes of a running server: edits, names, snapshots, keyframes, tiles and files of
// builds. Each call is one transaction. It fails (locked) and writes nothing if another program
// owns the world.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "common/edits/descriptor/edit_record.hpp"
#include "common/runs/chunk.hpp"
#include "server/store/keyframe.hpp"
#include "server/store/log_fold.hpp"
#include "server/store/store_error.hpp"
#include "server/world/environment/player_rows.hpp"
#include "server/world/environment/saved_state.hpp"

namespace runstone {

using ChunkSpan = std::span<const std::pair<ChunkKey, ChunkPtr>>;

class WorldSink {
 public:
  virtual ~WorldSink() = default;

  /// Returns false while another program may own the world. Then no edit may be ordered, because it
  /// may never be written. Thread: any.
  virtual bool is_owned() const { return true; }
  /// `on_lost` is called once, when another program owns the world or the connection to its
  /// database has ended: no write succeeds from then on. It is called on another thread, or in this
  /// call if it happened before. An empty function ends the watch; no call is under way when this
  /// returns. Thread: any.
  virtual void watch_ownership(std::function<void(const StoreError&)> /*on_lost*/) {}
  /// Publishes the address at which other servers of the world reach this one: HOST:PORT. A world
  /// that only one machine can reach has no place for it: the call then does nothing.
  virtual StoreResult<void> publish_address(const std::string& /*address*/) { return {}; }
  /// Gives the world up, so that another program need not wait. No write succeeds from then on.
  virtual void give_up() {}
  /// Writes new players, then records, then the watermarks that the records imply. All of it is
  /// durable on return. Fails (bad_request) and writes nothing if
  ///   - the records do not continue the log without a gap;
  ///   - a record is not of the epoch of this start;
  ///   - the fields of a record are not valid (validate_fields()).
  virtual StoreResult<void> append(std::span<const PlayerRow> players,
                                   std::span<const EditRecord> records) = 0;
  /// Writes claims of names and removes released ones, in this order. All of it is durable on
  /// return. It may be repeated. Fails (bad_request) if another key owns a claimed name.
  virtual StoreResult<void> change_names(std::span<const NameChange> changes) = 0;
  /// Replaces the state that is kept besides the log. The clock is left out if another record has
  /// set it last.
  virtual StoreResult<void> save_state(const SavedState& state) = 0;
  /// Replaces the snapshots of these chunks and, if given, moves the checkpoint. Deletes the tiles
  /// above these chunks that are older. Fails (bad_request) if a chunk or the checkpoint is ahead
  /// of the log.
  virtual StoreResult<void> save_snapshots(ChunkSpan chunks,
                                           std::optional<Sequence> checkpoint) = 0;
  /// Adds chunks as edits of the log left them and, if given, the keyframe that they complete. A
  /// chunk that is stored already stays. Fails (bad_request) if the chunks of base and keyframes do
  /// not prove the keyframe.
  virtual StoreResult<void> save_keyframe(ChunkSpan chunks,
                                          const std::optional<Keyframe>& keyframe) = 0;
  /// Writes a part of the file of a build, before the record that adds the build is appended. It is
  /// durable on return. Part 0 is the first one; each but the last has kBuildPartBytes bytes. The next
  /// raise_epoch() removes parts whose build was not added. Fails (bad_request) if a build has this
  /// content number.
  virtual StoreResult<void> save_build_part(std::uint64_t /*content*/, std::uint32_t /*part*/,
                                            ByteView /*data*/) {
    return failure(StoreError{StoreError::Kind::bad_request, "", "", "has no library of builds"});
  }
  /// Removes the parts of a file whose build is not added. Fails (bad_request) if a build has this
  /// content number.
  virtual StoreResult<void> remove_build_file(std::uint64_t /*content*/) { return {}; }
  /// Inserts or replaces tiles. Requires that each was made of chunks of this world, after it was
  /// opened for writing, and contains all edits below it up to its version. A tile is left out if a
  /// snapshot below it was saved meanwhile that is newer. All are left out if `rules`, by which
  /// they were made, are not those of the materials that are written (tile_rules_of()). Fails
  /// (bad_request) if a tile is ahead of the log.
  virtual StoreResult<void> save_tiles(ChunkSpan tiles, std::uint32_t rules) = 0;
  /// Moves the oldest edits of the log into the base: writes the chunks of a fold, moves the head
  /// of the log, and deletes the edits, their indexes, and the keyframes up to there. Changes of
  /// rights, textures and new materials stay, as for Store::compact(). Fails (bad_request) and
  /// writes nothing if
  ///   - the head of the log is not `from`;
  ///   - `to` is no edit of the log, or lies behind the checkpoint;
  ///   - the chunks are not those that the edits touch, or have other versions.
  virtual StoreResult<void> fold_log(const LogFold& /*fold*/) {
    return failure(StoreError{StoreError::Kind::bad_request, "", "", "cannot remove old edits"});
  }
  /// Gives up to so many pages of free space back to the disk. Returns true if more free space is
  /// left. Returns false at once if the database cannot give space back in parts.
  virtual StoreResult<bool> give_back_space(std::uint32_t /*pages*/) { return false; }
};

}  // namespace runstone
