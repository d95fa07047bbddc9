// FakeEnvironment: a WorldEnvironment of plain lists for tests: messages sent, loads, log records
// and snapshots. The test gives all answers.
#pragma once
#include <algorithm>
#include <deque>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/core/tile_keys.hpp"
#include "protocol/codec/message_table.hpp"
#include "server/world/environment/world_environment.hpp"

namespace runstone::test {

class FakeEnvironment : public WorldEnvironment {
 public:
  struct Sent {
    SessionId session = 0;
    EncodedMessage message;
  };
  struct SentSnapshot {
    SessionId session = 0;
    ChunkKey key;
    ChunkPtr chunk;
    std::uint32_t view = 0;  // number of the view that it answers
  };
  struct Closed {
    SessionId session = 0;
    GoodbyeReason reason{};
    std::string text;
  };
  struct Save {
    std::vector<std::pair<ChunkKey, ChunkPtr>> chunks;
    Sequence checkpoint = 0;
  };

  std::vector<Sent> sent;
  std::vector<Sent> unsent;  // messages that found the queue of their session full
  /// The calls of send_to_all(): the kind of the message, and the number of sessions.
  std::vector<std::pair<MessageKind, std::size_t>> rounds;
  std::vector<SentSnapshot> snapshots;                // updates included
  std::vector<std::pair<ChunkKey, Version>> updates;  // and the version that the session has
  std::vector<std::pair<SessionId, ChunkKey>>
      changed_tiles;  // of the snapshots, those that replace a tile
  std::vector<Closed> closed;
  std::vector<PlayerRow> players;
  std::vector<EditRecord> records;
  std::vector<NameChange> names;
  std::vector<ChatEntry> chat;
  std::vector<SavedState> states;
  std::deque<ChunkKey> loads;
  struct HistoryLoad {
    SessionId session = 0;
    HistoryNumber history{};
    Sequence at = 0;
    ChunkKey key;
  };
  std::vector<Save> saves;
  std::deque<TileRequest> tile_requests;
  std::deque<std::pair<SessionId, TileRequest>> past_tile_requests;
  std::map<ChunkKey, Sequence> tile_edits;  // the newest edit below each tile
  std::vector<std::pair<ChunkKey, ChunkPtr>> saved_tiles;
  std::vector<CachedChunk> current_tiles;  // copies that are known to be current
  mutable std::size_t tile_checks = 0;     // calls of is_tile_current()
  std::deque<std::pair<SessionId, HistoryRequest>> history_requests;
  std::deque<HistoryLoad> history_loads;
  std::deque<std::pair<SessionId, LogMarksRequest>> mark_requests;
  std::deque<std::pair<SessionId, BuildsRequest>> list_requests;
  std::deque<std::pair<SessionId, BuildPieceRequest>> piece_requests;
  struct BuildToVerify {
    UploadNumber upload{};
    std::vector<Bytes> parts;
  };
  struct BuildToSave {
    UploadNumber upload{};
    std::uint64_t content = 0;
    std::shared_ptr<const Bytes> file;
  };
  std::deque<BuildToVerify> builds_to_verify;
  std::deque<BuildToSave> builds_to_save;
  std::vector<std::uint64_t> removed_files;  // of builds, their content numbers
  bool is_file_writer_busy = false;          // another file of a build is being written
  std::vector<std::string> lines;
  std::vector<PlayerVisit> came, left;
  std::vector<std::string> commands;
  std::map<SessionId, SessionEncodings> encodings;
  std::set<SessionId> full;          // sessions whose queue is full
  std::set<SessionId> refuse_edits;  // sessions whose queue of the edits class is full
  std::map<SessionId, std::size_t> snapshot_room;  // snapshots that still fit; absent: no bound
  std::map<SessionId, std::size_t> charged;        // bytes beyond those of messages
  std::deque<EncodedMessage> to_owner;             // messages for the owner of the world
  bool is_owner_full = false;             // the queue of the connection with the owner is full
  std::vector<std::string> owners_left;   // why this server ended the connection with the owner
  std::deque<Sequence> missed_log_reads;  // the first record of each
  std::deque<OperationId> action_lookups;
  std::vector<SessionId> trusted;  // sessions of other servers
  bool is_owner = true;            // no other server may own the world
  bool log_room = true;
  bool disk_has_space = true;
  std::size_t log_records_max =
      std::numeric_limits<std::size_t>::max();  // records that are not written yet
  std::size_t log_written = 0;                  // written records
  std::size_t log_bytes = 0;                    // of memory that waiting records take

  bool send(SessionId session, const EncodedMessage& message) override {
    if (full.contains(session)) {
      unsent.push_back({session, message});
      return false;
    }
    if (class_of(message) == FrameClass::edits && refuse_edits.contains(session)) return false;
    sent.push_back({session, message});
    return true;
  }
  std::vector<SessionId> send_to_all(std::span<const SessionId> sessions,
                                     const EncodedMessage& message) override {
    rounds.emplace_back(message.kind, sessions.size());
    return WorldEnvironment::send_to_all(sessions, message);
  }
  bool send_snapshot(SessionId session, std::uint32_t view, const ChunkKey& key,
                     const ChunkPtr& chunk) override {
    if (full.contains(session)) return false;
    const auto room = snapshot_room.find(session);
    if (room != snapshot_room.end()) {
      if (room->second == 0) return false;
      --room->second;
    }
    snapshots.push_back({session, key, chunk, view});
    return true;
  }
  bool send_changed_tile(SessionId session, std::uint32_t view, const ChunkKey& key,
                         const ChunkPtr& tile) override {
    if (!send_snapshot(session, view, key, tile)) return false;
    changed_tiles.emplace_back(session, key);
    return true;
  }
  bool send_update(SessionId session, std::uint32_t view, const ChunkKey& key,
                   const ChunkPtr& chunk, Version held) override {
    if (!send_snapshot(session, view, key, chunk)) return false;
    updates.emplace_back(key, held);
    return true;
  }
  void set_encodings(SessionId session, SessionEncodings agreed) override {
    encodings[session] = agreed;
  }
  void close(SessionId session, GoodbyeReason reason, const std::string& text) override {
    closed.push_back({session, reason, text});
  }
  bool log_has_room(std::size_t more) const override {
    return disk_has_space && log_has_queue_room(more);
  }
  bool log_has_queue_room(std::size_t more) const override {
    return log_room && more <= log_records_max &&
           records.size() - log_written <= log_records_max - more;
  }
  void charge_reading(SessionId session, std::size_t bytes) override { charged[session] += bytes; }
  std::size_t log_queued_bytes() const override { return log_bytes; }
  void log_append(std::vector<PlayerRow> new_players,
                  std::vector<EditRecord> new_records) override {
    players.insert(players.end(), new_players.begin(), new_players.end());
    records.insert(records.end(), new_records.begin(), new_records.end());
  }
  void log_names(std::vector<NameChange> changes) override {
    names.insert(names.end(), changes.begin(), changes.end());
  }
  bool save_state(SavedState state) override {
    if (!log_has_room(1)) return false;
    states.push_back(std::move(state));
    return true;
  }
  void log_chat(const ChatEntry& entry) override { chat.push_back(entry); }
  void withdraw_chat(const PublicKey& key, const std::vector<TimeUs>& times) override {
    for (ChatEntry& entry : chat) {
      if (entry.key == key && std::ranges::find(times, entry.line.utc_us) != times.end())
        entry.is_withdrawn = true;
    }
  }
  void load_chunk(const ChunkKey& key) override { loads.push_back(key); }
  void make_tile(TileRequest request) override { tile_requests.push_back(std::move(request)); }
  void make_past_tile(SessionId session, TileRequest request) override {
    past_tile_requests.emplace_back(session, std::move(request));
  }
  void tiles_edited(std::span<const ChunkKey> chunks, Sequence seq) override {
    for (const ChunkKey& chunk : chunks) {
      for (std::uint8_t level = 1; level <= kTileLevelMax; ++level) {
        Sequence& newest = tile_edits[tile_of(chunk.at, level)];
        newest = std::max(newest, seq);
      }
    }
  }
  Sequence newest_tile_edit(const ChunkKey& tile) const override {
    const auto found = tile_edits.find(tile);
    return found == tile_edits.end() ? 0 : found->second;
  }
  bool is_tile_current(const CachedChunk& copy) const override {
    ++tile_checks;
    return std::ranges::find(current_tiles, copy) != current_tiles.end();
  }
  void save_tiles(std::vector<std::pair<ChunkKey, ChunkPtr>> tiles) override {
    saved_tiles.insert(saved_tiles.end(), tiles.begin(), tiles.end());
  }
  void command(SessionId /*session*/, AuthorId /*author*/, const PublicKey& /*key*/,
               const std::string& text) override {
    commands.push_back(text);
  }
  void open_history(SessionId session, const HistoryRequest& request) override {
    history_requests.emplace_back(session, request);
  }
  void read_log_marks(SessionId session, const LogMarksRequest& request) override {
    mark_requests.emplace_back(session, request);
  }
  void find_builds(SessionId session, const BuildsRequest& request) override {
    list_requests.emplace_back(session, request);
  }
  void read_build_piece(SessionId session, const BuildPieceRequest& request) override {
    piece_requests.emplace_back(session, request);
  }
  void verify_build(UploadNumber upload, std::vector<Bytes> parts) override {
    builds_to_verify.push_back({upload, std::move(parts)});
  }
  bool save_build_file(UploadNumber upload, std::uint64_t content,
                       std::shared_ptr<const Bytes> file) override {
    if (is_file_writer_busy) return false;
    builds_to_save.push_back({upload, content, std::move(file)});
    return true;
  }
  void remove_build_file(std::uint64_t content) override { removed_files.push_back(content); }
  void load_history_chunk(SessionId session, HistoryNumber history, Sequence at,
                          const ChunkKey& key) override {
    history_loads.push_back({session, history, at, key});
  }
  void save_snapshots(std::vector<std::pair<ChunkKey, ChunkPtr>> chunks,
                      Sequence checkpoint) override {
    saves.push_back({std::move(chunks), checkpoint});
  }
  bool send_to_owner(const EncodedMessage& message) override {
    if (!is_owner_full) to_owner.push_back(message);
    return !is_owner_full;
  }
  bool owns_world() const override { return is_owner; }
  void leave_owner(const std::string& why) override { owners_left.push_back(why); }
  void read_missed_log(Sequence first) override { missed_log_reads.push_back(first); }
  void find_action(const OperationId& first_op) override { action_lookups.push_back(first_op); }
  void trust(SessionId session) override { trusted.push_back(session); }
  void player_came(const PlayerVisit& visit) override { came.push_back(visit); }
  void player_left(const PlayerVisit& visit) override { left.push_back(visit); }
  void report(OperatorLogLevel /*level*/, const std::string& line) override {
    lines.push_back(line);
  }

  /// Returns the messages of one kind sent to a session, oldest first.
  template <class Kind>
  std::vector<Kind> messages(SessionId session, std::uint16_t chunk_edge) const {
    std::vector<Kind> found;
    for (const Sent& s : sent) {
      if (s.session != session) continue;
      if (s.message.kind != kKindOf<Kind>) continue;
      auto message = decode_message(Sender::server, s.message.kind, *s.message.bytes, chunk_edge);
      RUNSTONE_ASSERT(message.has_value());
      found.push_back(std::get<Kind>(*std::move(message)));
    }
    return found;
  }
};

/// Returns a base chunk that is not uniform: it has a voxel in its last corner.
inline Chunk dotted_chunk(unsigned edge) {
  Chunk chunk;
  chunk.voxels = uniform_chunk(Extent::cube(edge), kEmpty);
  fill(chunk.voxels, chunk.voxels.volume() - 1, 1, 1);
  chunk.digest = digest_of(chunk.voxels);
  return chunk;
}

/// Returns an empty base chunk.
inline Chunk empty_chunk(unsigned edge) {
  Chunk chunk;
  chunk.voxels = uniform_chunk(Extent::cube(edge), kEmpty);
  return chunk;
}

}  // namespace runstone::test
