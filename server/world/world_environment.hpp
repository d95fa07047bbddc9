// WorldEnvironment: all that the world strand needs from outside. The server program implements them with threads,
// sockets and SQLite; the simulation with queues and virtual time. Every call returns at once; answers come
// back later as calls of WorldServer on the world strand. Bounded, with a written answer to "full" at each
// place.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/core/ids.hpp"
#include "common/edits/descriptor/edit_record.hpp"
#include "common/runs/chunk.hpp"
#include "protocol/codec/messages.hpp"
#include "server/world/player_rows.hpp"

namespace runstone {

/// What the world strand has to tell the operator; the port names the logger.
enum class WorldLogLevel { debug, info, warn, error };

/// Where in the log a past moment lies.
struct OpenedMoment {
  Sequence seq = 0;   // its last edit; 0: before the first one
  TimeUs utc_us = 0;  // when that was ordered
};

class WorldEnvironment {
 public:
  virtual ~WorldEnvironment() = default;

  /// Queues a message behind the session's earlier ones of its class. False: the session's queue is full and
  /// the message was dropped; the caller decides what that means (commits: chunk marked stale; control:
  /// session closed).
  virtual bool send(SessionId session, const EncodedMessage& message) = 0;
  /// As send() to each, in this order. Returns those whose queue is full.
  virtual std::vector<SessionId> send_to_all(std::span<const SessionId> sessions,
                                             const EncodedMessage& message) {
    std::vector<SessionId> full;
    for (const SessionId session : sessions) {
      if (!send(session, message)) full.push_back(session);
    }
    return full;
  }
  /// The encoding agreed with a session; called once, before its first send_snapshot().
  virtual void set_encoding(SessionId /*session*/, ChunkEncoding /*encoding*/) {}
  /// The optional parts of the protocol in force with a session; called once, before ready.
  virtual void set_features(SessionId /*session*/, std::uint64_t /*features*/) {}
  /// The session has proved its key: from now on it is a player.
  virtual void opened(SessionId /*session*/) {}
  /// Encodes a snapshot on a worker in the session's encoding and queues it like send(). False as above; a
  /// port with a bounded queue calls WorldServer::drained() when there is room again.
  virtual bool send_snapshot(SessionId session, const ChunkKey& key, const ChunkPtr& chunk) = 0;
  /// As send_snapshot(), for a session that holds the chunk at an earlier version: where the edits from there to the
  /// chunk's version are in the log and shorter, a worker sends those instead. Requires that they are durable.
  virtual bool send_update(SessionId session, const ChunkKey& key, const ChunkPtr& chunk,
                           Version /*held*/) {
    return send_snapshot(session, key, chunk);
  }
  /// The session's view is this one now: snapshots outside of it that nothing was sent of yet need not be sent.
  virtual void forget_outside(SessionId /*session*/, const View& /*view*/) {}
  /// Sends goodbye after what is queued, then closes. disconnected() follows.
  virtual void close(SessionId session, GoodbyeReason reason, const std::string& text) = 0;

  /// Room in the log queue for `records` more; false: reject edits as busy.
  virtual bool log_has_room(std::size_t records) const = 0;
  /// Hands a commit's records to the log writer, and with them players to be written or written anew (also
  /// without records). Answer: WorldServer::durable() once records are on disk.
  virtual void log_append(std::vector<PlayerRow> players, std::vector<EditRecord> records) = 0;
  /// Asks for a chunk: newest snapshot, else base, else generated, from a worker. Answer:
  /// WorldServer::chunk_loaded() or chunk_failed(). Asked at most once per chunk until answered.
  virtual void load_chunk(const ChunkKey& key) = 0;
  /// Opens the moment that a session wants to see (travel.to is not live), on a worker. Answer:
  /// WorldServer::moment_opened(). Asked at most once per session until answered.
  virtual void open_moment(SessionId /*session*/, const HistoryRequest& /*travel*/) {}
  /// Makes a chunk as it stood after edit `at`, on a worker. Answer: WorldServer::past_chunk().
  virtual void load_past_chunk(SessionId /*session*/, std::uint32_t /*visit*/, Sequence /*at*/,
                               const ChunkKey& /*key*/) {}
  /// Hands over immutable chunks to be written as snapshots (each version <= durable), and the sequence up to
  /// which everything is then contained in snapshots. Answer: WorldServer::snapshots_saved().
  virtual void save_snapshots(std::vector<std::pair<ChunkKey, ChunkPtr>> chunks,
                              Sequence checkpoint) = 0;

  /// A client's command, to be carried out. Answers: WorldServer::answer_command(), the last one done. A session has
  /// one command under way at a time. The key is the player's, for permissions.
  virtual void command(SessionId /*session*/, AuthorId /*author*/, const PublicKey& /*key*/,
                       const std::string& /*text*/) {}

  /// One line for the operator, with fields as in "session=7 chunk=1,0,-3 seq=9120".
  virtual void log(WorldLogLevel /*level*/, const std::string& /*line*/) {}
};

}  // namespace runstone
