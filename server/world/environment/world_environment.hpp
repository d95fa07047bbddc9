// WorldEnvironment: everything that the world strand needs from outside. The server program
// implements it with threads, sockets and SQLite, the simulation with queues and virtual time.
// Every call returns at once and must not call WorldServer. Answers come later, as calls of
// WorldServer on the world strand. Every queue behind a call is bounded; each comment says what
// happens when it is full.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/core/ids.hpp"
#include "common/edits/descriptor/edit_record.hpp"
#include "common/edits/descriptor/library_change.hpp"
#include "common/runs/chunk.hpp"
#include "protocol/codec/messages.hpp"
#include "protocol/codec/session_encodings.hpp"
#include "server/world/environment/chat_entry.hpp"
#include "server/world/environment/player_rows.hpp"
#include "server/world/environment/saved_state.hpp"
#include "server/world/environment/tile_request.hpp"

namespace runstone {

/// Levels of a line for the operator. The environment chooses the logger.
enum class OperatorLogLevel { debug, info, warn, error };

/// Identifies a history view among all of the server, from 1. Answers of workers carry it.
enum class HistoryNumber : std::uint32_t {};

/// A session of a player, for the operator's log.
struct PlayerVisit {
  SessionId session = 0;
  AuthorId author = 0;
  std::string name;
  PublicKey key{};
  std::size_t players = 0;  // open sessions, this one included if it is open
};

/// Identifies an upload of a build among all of the server, from 1. Answers of workers carry it.
enum class UploadNumber : std::uint32_t {};

/// The place in the log where a view of the past ends.
struct OpenedHistory {
  Sequence seq = 0;   // the last edit that the view contains; 0: none
  TimeUs utc_us = 0;  // the time when that edit was ordered
};

/// Marks of the log that a reader has found.
struct FoundLogMarks {
  Sequence first = 1;          // of the log; at least 1
  std::vector<LogMark> marks;  // as in LogMarks
  /// The work of a question about one voxel, otherwise 0: one unit for each segment of the index, each
  /// record and each KiB of edits that were read. A unit takes a few microseconds of a reader.
  std::uint64_t cost = 0;
};

/// Builds of the library that a reader has found.
struct FoundBuilds {
  std::vector<ListedBuild> builds;  // as in Builds, without the names of those who added them
  bool has_more = false;            // older builds fit, too
};

/// The file of a build, which a worker has verified.
struct VerifiedBuild {
  AddBuild build;  // its content number is not drawn yet
  std::shared_ptr<const Bytes> file;
};

/// An action as the log holds it.
struct FoundAction {
  Sequence first = 0;      // its first edit; 0: the log does not have it
  bool is_undone = false;  // its last toggle is an undo
};

/// Why a chunk could not be loaded.
enum class LoadFailure : std::uint8_t {
  damaged,  // its row does not decode, or contradicts the log
  not_read  // it could not be read now, for example because too many files are open
};

class WorldEnvironment {
 public:
  virtual ~WorldEnvironment() = default;

  /// Queues a message behind the session's earlier messages of its class. Returns false if the
  /// session's queue is full; the message is dropped then, and the caller decides what follows.
  /// Returns true if the session is not connected.
  virtual bool send(SessionId session, const EncodedMessage& message) = 0;
  /// Calls send() for each session, in this order. Returns the sessions whose queue is full.
  virtual std::vector<SessionId> send_to_all(std::span<const SessionId> sessions,
                                             const EncodedMessage& message) {
    std::vector<SessionId> full;
    for (const SessionId session : sessions) {
      if (!send(session, message)) full.push_back(session);
    }
    return full;
  }
  /// Sets the encodings agreed with a session. Called once, before its first send_snapshot().
  virtual void set_encodings(SessionId /*session*/, SessionEncodings /*encodings*/) {}
  /// Sets the optional parts of the protocol in force with a session. Called once, before session
  /// accepted.
  virtual void set_features(SessionId /*session*/, std::uint64_t /*features*/) {}
  /// Reports that the session has authenticated its key. It may still wait for the claim of its
  /// name.
  virtual void opened(SessionId /*session*/) {}
  /// Encodes a snapshot on a worker, in the session's encoding of chunks or tiles, and queues it
  /// like send(), as an answer to the view of this number. Returns false as send() does.
  /// WorldServer::drained() is called when the queue has room again.
  virtual bool send_snapshot(SessionId session, std::uint32_t view, const ChunkKey& key,
                             const ChunkPtr& chunk) = 0;
  /// Queues a tile that replaces one that the session has, as send_snapshot() does, but in the
  /// encoding of chunks.
  /// After an edit many sessions get the tile, and the time to read it delays their edits.
  virtual bool send_changed_tile(SessionId session, std::uint32_t view, const ChunkKey& key,
                                 const ChunkPtr& tile) {
    return send_snapshot(session, view, key, tile);
  }
  /// Queues a chunk for a session that has it at the earlier version `held`. A worker sends the
  /// edits between the two versions if the log has them and they are shorter than a snapshot,
  /// otherwise a snapshot. Returns false as send() does. Requires that the edits are durable.
  virtual bool send_update(SessionId session, std::uint32_t view, const ChunkKey& key,
                           const ChunkPtr& chunk, Version /*held*/) {
    return send_snapshot(session, view, key, chunk);
  }
  /// Allows to drop queued snapshots outside of the session's view, if no byte of them was sent.
  virtual void forget_outside(SessionId /*session*/, const View& /*view*/) {}
  /// Lifts the limits of a session that has proved to be another server of this world.
  virtual void trust(SessionId /*session*/) {}
  /// Sends goodbye behind the queued edits and control messages, then closes the connection.
  /// Answer: WorldServer::disconnected().
  virtual void close(SessionId session, GoodbyeReason reason, const std::string& text) = 0;

  /// Counts `bytes` more as read from the session, because one of its messages cost more than its
  /// size says. The server then waits longer before it reads from the session again.
  virtual void charge_reading(SessionId /*session*/, std::size_t /*bytes*/) {}

  /// Returns false while another server may own the world. Then nobody is let in, because that
  /// server may know more of the player.
  virtual bool owns_world() const { return true; }
  /// Returns true if the log queue has room for `records` more. If not, edits are rejected busy.
  virtual bool log_has_room(std::size_t records) const = 0;
  /// Returns true also while the disk has no space, otherwise as log_has_room(): the records then
  /// wait in memory, and are lost if no space comes before the stop.
  virtual bool log_has_queue_room(std::size_t records) const { return log_has_room(records); }
  /// Returns the bytes of memory that the records take that are not durable yet.
  virtual std::size_t log_queued_bytes() const = 0;
  /// Queues records for the log writer, and rows of players to be written with them. There may be
  /// rows without records. Requires log_has_queue_room(). Answer to records:
  /// WorldServer::durable().
  virtual void log_append(std::vector<PlayerRow> players, std::vector<EditRecord> records) = 0;
  /// Queues changes of names for the log writer, ahead of all records that are queued later.
  /// Requires log_has_room(1). Answer: WorldServer::names_durable().
  virtual void log_names(std::vector<NameChange> changes) = 0;
  /// Queues a line for the log of the chat. If that queue is full, the line is not logged.
  virtual void log_chat(const ChatEntry& /*entry*/) {}
  /// Marks the lines of a player with these times as withdrawn in the log of the chat.
  virtual void withdraw_chat(const PublicKey& /*key*/, const std::vector<TimeUs>& /*times*/) {}
  /// Loads a chunk on a worker: its newest snapshot, else the base, else generated. Called at most
  /// once for a chunk until it is answered. Answer: WorldServer::chunk_loaded() or chunk_failed().
  virtual void load_chunk(const ChunkKey& key) = 0;
  /// Makes a tile on a worker. Called at most once for a tile until it is answered. Answer:
  /// Tiles::made() or stopped(). Without tiles (WorldConfig::tile_levels_max is 0), this call,
  /// make_past_tile(), tiles_edited(), newest_tile_edit(), is_tile_current() and save_tiles() are
  /// not made.
  virtual void make_tile(TileRequest /*request*/) {}
  /// Makes the tile of a request that has `at`, for a session that sees the past. Answer:
  /// Tiles::past_made() or past_stopped().
  virtual void make_past_tile(SessionId /*session*/, TileRequest /*request*/) {}
  /// Records that the newest edit of these chunks is `seq`, before any later make_tile(). Keys of
  /// level of detail 0, ascending.
  virtual void tiles_edited(std::span<const ChunkKey> /*chunks*/, Sequence /*seq*/) {}
  /// Returns the newest edit below a tile that tiles_edited() recorded, or 0.
  virtual Sequence newest_tile_edit(const ChunkKey& /*tile*/) const { return 0; }
  /// Returns true if a client's copy of a tile is known to be the tile as it is now, without making
  /// it.
  virtual bool is_tile_current(const CachedChunk& /*copy*/) const { return false; }
  /// Writes tiles to the folder, at a low priority. If the queue is full, they are not written.
  virtual void save_tiles(std::vector<std::pair<ChunkKey, ChunkPtr>> /*tiles*/) {}
  /// Finds the view of the past that a session requests, on a worker. Requires that request.to is
  /// not live. Called at most once for a session until it is answered. Answer:
  /// Ground::history_opened().
  virtual void open_history(SessionId /*session*/, const HistoryRequest& /*request*/) {}
  /// Makes a chunk as it was after edit `at`, on a worker. The answer repeats `history`. Answer:
  /// Ground::history_chunk_loaded().
  virtual void load_history_chunk(SessionId /*session*/, HistoryNumber /*history*/, Sequence /*at*/,
                                  const ChunkKey& /*key*/) {}
  /// Reads marks of the log, on a reader. Called at most once for a session until it is answered.
  /// Answer: Ground::log_marks_read().
  virtual void read_log_marks(SessionId /*session*/, const LogMarksRequest& /*request*/) {}
  /// Reads a page of the library of builds, on a reader. Called at most once for a session until it
  /// is answered. Answer: BuildReads::found().
  virtual void find_builds(SessionId /*session*/, const BuildsRequest& /*request*/) {}
  /// Reads a piece of the file of a build, on a reader. Called at most once for a session until it is
  /// answered. Answer: BuildReads::piece_read().
  virtual void read_build_piece(SessionId /*session*/, const BuildPieceRequest& /*request*/) {}
  /// Joins the parts of an uploaded file, at least one, and verifies all of it, on a worker. Answer:
  /// BuildUploads::verified().
  virtual void verify_build(UploadNumber /*upload*/, std::vector<Bytes> /*parts*/) {}
  /// Writes the file of a build, under a content number, behind the records that are queued. Returns
  /// false if another file is being written, or if the log cannot be written; there is no answer then.
  /// Answer: BuildUploads::saved().
  virtual bool save_build_file(UploadNumber /*upload*/, std::uint64_t /*content*/,
                               std::shared_ptr<const Bytes> /*file*/) {
    return false;
  }
  /// Removes a file that save_build_file() has written and whose build is not added.
  virtual void remove_build_file(std::uint64_t /*content*/) {}
  /// Writes immutable chunks as snapshots, then moves the checkpoint: every edit up to it is
  /// contained in snapshots. Requires that each chunk's version is durable. Answer:
  /// WorldServer::snapshots_saved().
  virtual void save_snapshots(std::vector<std::pair<ChunkKey, ChunkPtr>> chunks,
                              Sequence checkpoint) = 0;

  /// Queues a message for the owner of the world, which this server follows. Returns false if there
  /// is no room, or no connection.
  virtual bool send_to_owner(const EncodedMessage& /*message*/) { return false; }
  /// Ends the connection with the owner. Answer: Cluster::owner_disconnected().
  virtual void leave_owner(const std::string& /*why*/) {}
  /// Reads durable records from `first` on, on a reader. Called at most once until it is answered.
  /// Answer: Cluster::missed_log_read().
  virtual void read_missed_log(Sequence /*first*/) {}

  /// Looks an action up in the log, on a reader, by the operation of its first edit. Answer:
  /// EditRequests::action_found().
  virtual void find_action(const OperationId& /*first_op*/) {}

  /// Carries out a client's command. The key of the player decides its permissions. Called at most
  /// once for a session until it is answered. Answers: Commands::answer(), the last one
  /// with is_done.
  virtual void command(SessionId /*session*/, AuthorId /*author*/, const PublicKey& /*key*/,
                       const std::string& /*text*/) {}

  /// Reports that a player has joined or left. A session that leaves is closed, or its connection
  /// has ended.
  virtual void player_came(const PlayerVisit& /*visit*/) {}
  virtual void player_left(const PlayerVisit& /*visit*/) {}
  /// Writes one line for the operator, with fields as in "session=7 chunk=1,0,-3 seq=9120".
  virtual void report(OperatorLogLevel /*level*/, const std::string& /*line*/) {}
  /// Queues the state that is kept besides the log. The newest state that is queued replaces those
  /// before it. Returns false, and takes nothing, if the log takes nothing or has no room.
  virtual bool save_state(SavedState state) = 0;
};

}  // namespace runstone
