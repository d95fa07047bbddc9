// ServerEnvironment: the WorldEnvironment of the server program. It carries out the requests of the
// world strand with connections, readers and the log writer, and passes the answers to WorldServer
// in tasks of the world strand. Threads: the world strand.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "server/chat/chat_log.hpp"
#include "server/net/listener.hpp"
#include "server/runtime/chunk_sender.hpp"
#include "server/runtime/command_runner.hpp"
#include "server/runtime/connected_sessions.hpp"
#include "server/runtime/durable_log.hpp"
#include "server/runtime/operator_log.hpp"
#include "server/runtime/owner_connection.hpp"
#include "server/runtime/tile_making.hpp"
#include "server/runtime/world_readers.hpp"
#include "server/world/environment/world_environment.hpp"

namespace runstone {

class ServerEnvironment final : public WorldEnvironment {
 public:
  /// All must outlive the object.
  ServerEnvironment(WorldStrand& strand, ConnectedSessions& sessions, Listener& listener,
                    ChunkSender& sender, WorldReaders& readers, TileMaking& tiles,
                    OwnerConnection& owner)
      : strand_(strand),
        sessions_(sessions),
        listener_(listener),
        sender_(sender),
        readers_(readers),
        tiles_(tiles),
        owner_(owner) {}

  /// Connects the world, which is made after the environment. Call it once, before the first
  /// session connects. `chat_log` may be null. Both must outlive the object.
  void attach(WorldServer& world, ChatLog* chat_log) {
    world_ = &world;
    chat_log_ = chat_log;
  }
  /// Connects what the owner of the world has. Until then, the log has no room. Both must outlive
  /// the object, the log until detach_log().
  void attach(DurableLog& log, CommandRunner& commands) {
    log_ = &log;
    commands_ = &commands;
  }
  /// From now on the log has no room.
  void detach_log() { log_ = nullptr; }

  /// Returns the processor time that send_to_all() took since the start. It does not include the
  /// time of sending.
  std::int64_t enqueue_ns() const { return enqueue_ns_; }

  bool send(SessionId session, const EncodedMessage& message) override;
  std::vector<SessionId> send_to_all(std::span<const SessionId> sessions,
                                     const EncodedMessage& message) override;
  void set_encodings(SessionId session, SessionEncodings encodings) override;
  void set_features(SessionId session, std::uint64_t features) override;
  void opened(SessionId session) override;
  bool send_changed_tile(SessionId session, std::uint32_t view, const ChunkKey& key,
                         const ChunkPtr& tile) override;
  bool send_snapshot(SessionId session, std::uint32_t view, const ChunkKey& key,
                     const ChunkPtr& chunk) override;
  bool send_update(SessionId session, std::uint32_t view, const ChunkKey& key,
                   const ChunkPtr& chunk, Version held) override;
  void forget_outside(SessionId session, const View& view) override;
  void close(SessionId session, GoodbyeReason reason, const std::string& text) override;
  void charge_reading(SessionId session, std::size_t bytes) override;
  void trust(SessionId session) override;
  bool send_to_owner(const EncodedMessage& message) override;
  void leave_owner(const std::string& why) override;
  void read_missed_log(Sequence first) override;
  void find_action(const OperationId& first_op) override;
  bool owns_world() const override;
  bool log_has_room(std::size_t records) const override;
  bool log_has_queue_room(std::size_t records) const override;
  std::size_t log_queued_bytes() const override;
  void log_append(std::vector<PlayerRow> players, std::vector<EditRecord> records) override;
  void log_names(std::vector<NameChange> changes) override;
  bool save_state(SavedState state) override;
  void log_chat(const ChatEntry& entry) override;
  void withdraw_chat(const PublicKey& key, const std::vector<TimeUs>& times) override;
  void load_chunk(const ChunkKey& key) override;
  void make_tile(TileRequest request) override;
  void make_past_tile(SessionId session, TileRequest request) override;
  void tiles_edited(std::span<const ChunkKey> chunks, Sequence seq) override;
  Sequence newest_tile_edit(const ChunkKey& tile) const override;
  bool is_tile_current(const CachedChunk& copy) const override;
  void save_tiles(std::vector<std::pair<ChunkKey, ChunkPtr>> tiles) override;
  void open_history(SessionId session, const HistoryRequest& request) override;
  void load_history_chunk(SessionId session, HistoryNumber history, Sequence at,
                          const ChunkKey& key) override;
  void read_log_marks(SessionId session, const LogMarksRequest& request) override;
  void find_builds(SessionId session, const BuildsRequest& request) override;
  void read_build_piece(SessionId session, const BuildPieceRequest& request) override;
  void verify_build(UploadNumber upload, std::vector<Bytes> parts) override;
  bool save_build_file(UploadNumber upload, std::uint64_t content,
                       std::shared_ptr<const Bytes> file) override;
  void remove_build_file(std::uint64_t content) override;
  void save_snapshots(std::vector<std::pair<ChunkKey, ChunkPtr>> chunks,
                      Sequence checkpoint) override;
  void command(SessionId session, AuthorId author, const PublicKey& key,
               const std::string& text) override;
  void player_came(const PlayerVisit& visit) override;
  void player_left(const PlayerVisit& visit) override;
  void report(OperatorLogLevel level, const std::string& line) override;

 private:
  WorldStrand& strand_;
  ConnectedSessions& sessions_;
  Listener& listener_;
  ChunkSender& sender_;
  WorldReaders& readers_;
  TileMaking& tiles_;
  OwnerConnection& owner_;
  OperatorLog lines_;
  WorldServer* world_ = nullptr;
  DurableLog* log_ = nullptr;
  CommandRunner* commands_ = nullptr;
  ChatLog* chat_log_ = nullptr;
  std::int64_t enqueue_ns_ = 0;
};

}  // namespace runstone
