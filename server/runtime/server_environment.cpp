#include "server/runtime/server_environment.hpp"

#include "common/core/assert.hpp"
#include "common/os/thread_cpu_ns.hpp"
#include "server/history/find_action.hpp"
#include "server/runtime/logging.hpp"
#include "server/runtime/read_clocks.hpp"
#include "server/runtime/recovery.hpp"
#include "server/runtime/visit_line.hpp"

namespace runstone {

bool ServerEnvironment::send(SessionId session, const EncodedMessage& message) {
  const auto& net = sessions_.find(session);
  // A closed session accepts everything: its messages are dropped.
  return net == nullptr || net->send(message);
}

std::vector<SessionId> ServerEnvironment::send_to_all(std::span<const SessionId> sessions,
                                                      const EncodedMessage& message) {
  const std::int64_t began_ns = thread_cpu_ns();
  std::vector<SessionId> full;
  {
    SendRound round = listener_.begin_round(message);
    for (const SessionId session : sessions) {
      const auto& net = sessions_.find(session);
      if (net != nullptr && !net->send(message, round)) full.push_back(session);
    }
  }
  enqueue_ns_ += thread_cpu_ns() - began_ns;
  return full;
}

void ServerEnvironment::set_encodings(SessionId session, SessionEncodings encodings) {
  if (const auto& net = sessions_.find(session)) net->set_encodings(encodings);
}

void ServerEnvironment::set_features(SessionId session, std::uint64_t features) {
  if (const auto& net = sessions_.find(session)) net->set_features(features);
}

void ServerEnvironment::opened(SessionId session) { listener_.opened(session); }

bool ServerEnvironment::send_changed_tile(SessionId session, std::uint32_t view,
                                          const ChunkKey& key, const ChunkPtr& tile) {
  const auto& net = sessions_.find(session);
  return net == nullptr || sender_.send_changed_tile(net, view, key, tile);
}

bool ServerEnvironment::send_snapshot(SessionId session, std::uint32_t view, const ChunkKey& key,
                                      const ChunkPtr& chunk) {
  const auto& net = sessions_.find(session);
  return net == nullptr || sender_.send_snapshot(net, view, key, chunk);
}

bool ServerEnvironment::send_update(SessionId session, std::uint32_t view, const ChunkKey& key,
                                    const ChunkPtr& chunk, Version held) {
  const auto& net = sessions_.find(session);
  return net == nullptr || sender_.send_update(net, view, key, chunk, held);
}

void ServerEnvironment::forget_outside(SessionId session, const View& view) {
  if (const auto& net = sessions_.find(session)) net->forget_outside(view);
}

void ServerEnvironment::close(SessionId session, GoodbyeReason reason, const std::string& text) {
  if (const auto& net = sessions_.find(session)) net->close(reason, text);
}

void ServerEnvironment::charge_reading(SessionId session, std::size_t bytes) {
  if (const auto& net = sessions_.find(session)) net->charge_reading(bytes);
}

void ServerEnvironment::trust(SessionId session) {
  if (const auto& net = sessions_.find(session)) net->trust();
}

bool ServerEnvironment::send_to_owner(const EncodedMessage& message) {
  return owner_.send(message);
}

void ServerEnvironment::leave_owner(const std::string& why) { owner_.leave(why); }

void ServerEnvironment::read_missed_log(Sequence first) {
  const auto found = std::make_shared<Result<ReadLog, std::string>>(ReadLog{});
  const auto work = [found, first](WorldReader& reader, const Generator& /*generator*/) {
    *found = runstone::read_missed_log(reader, first);
  };
  readers_.run_on_log_reader(work, [this, found](const std::string& error) {
    if (!error.empty()) *found = failure(error);
    world_->cluster().missed_log_read(*found, read_clocks());
  });
}

void ServerEnvironment::find_action(const OperationId& first_op) {
  const auto found = std::make_shared<std::optional<FoundAction>>();
  const auto work = [found, first_op](WorldReader& reader, const Generator& /*generator*/) {
    if (const auto action = runstone::find_action(reader, first_op)) *found = *action;
  };
  readers_.run_on_log_reader(work, [this, found, first_op](const std::string& /*error*/) {
    world_->people().edits().action_found(first_op, *found, read_clocks());
  });
}

bool ServerEnvironment::owns_world() const { return log_ != nullptr && log_->is_owned(); }

bool ServerEnvironment::log_has_room(std::size_t records) const {
  return log_ != nullptr && log_->writer().has_room(records);
}

bool ServerEnvironment::log_has_queue_room(std::size_t records) const {
  return log_ != nullptr && log_->writer().has_queue_room(records);
}

std::size_t ServerEnvironment::log_queued_bytes() const {
  return log_ == nullptr ? 0 : log_->writer().queued_bytes();
}

void ServerEnvironment::log_append(std::vector<PlayerRow> players,
                                   std::vector<EditRecord> records) {
  log_->writer().append(std::move(players), std::move(records));
}

void ServerEnvironment::log_names(std::vector<NameChange> changes) {
  log_->writer().change_names(std::move(changes));
}

bool ServerEnvironment::save_state(SavedState state) {
  return log_ != nullptr && log_->writer().save_state(std::move(state));
}

void ServerEnvironment::log_chat(const ChatEntry& entry) {
  if (chat_log_ != nullptr) chat_log_->append(entry);
}

void ServerEnvironment::withdraw_chat(const PublicKey& key, const std::vector<TimeUs>& times) {
  if (chat_log_ != nullptr) chat_log_->withdraw(key, times);
}

void ServerEnvironment::load_chunk(const ChunkKey& key) {
  readers_.load_chunk(key, [this, key](StoreResult<Chunk> loaded) {
    if (loaded) {
      world_->chunk_loaded(key, *std::move(loaded), read_clocks());
    } else {
      world_->chunk_failed(key,
                           loaded.error().may_pass() ? LoadFailure::not_read : LoadFailure::damaged,
                           loaded.error().message(), read_clocks());
    }
  });
}

void ServerEnvironment::make_tile(TileRequest request) {
  tiles_.make(std::move(request), world_->order().materials(), world_->order().newest_materials(),
              [this](const ChunkKey& key, const std::vector<MadeTile>& made, TileMaking::End end) {
                if (end == TileMaking::End::stopped)
                  return world_->ground().tiles().stopped(key, made, read_clocks());
                world_->ground().tiles().made(key, made, read_clocks());
              });
}

void ServerEnvironment::make_past_tile(SessionId session, TileRequest request) {
  const auto then = [this, session, request](const ChunkKey& /*key*/,
                                             const std::vector<MadeTile>& made,
                                             TileMaking::End end) {
    if (end == TileMaking::End::stopped)
      return world_->ground().tiles().past_stopped(session, request, made, read_clocks());
    world_->ground().tiles().past_made(session, request, made, read_clocks());
  };
  tiles_.make(std::move(request), world_->order().materials(), world_->order().newest_materials(),
              then);
}

void ServerEnvironment::tiles_edited(std::span<const ChunkKey> chunks, Sequence seq) {
  tiles_.edited(chunks, seq);
}

Sequence ServerEnvironment::newest_tile_edit(const ChunkKey& tile) const {
  return tiles_.newest_edit(tile);
}

bool ServerEnvironment::is_tile_current(const CachedChunk& copy) const {
  return tiles_.is_current(copy, world_->order().tile_rules());
}

void ServerEnvironment::save_tiles(std::vector<std::pair<ChunkKey, ChunkPtr>> tiles) {
  if (log_ != nullptr) tiles_.save(std::move(tiles), world_->order().tile_rules(), log_->writer());
}

void ServerEnvironment::open_history(SessionId session, const HistoryRequest& request) {
  readers_.open_history(request, [this, session, request = request.request](
                                     const WorldReaders::OpenedHistoryResult& opened) {
    world_->ground().history_opened(session, request, opened, read_clocks());
  });
}

void ServerEnvironment::load_history_chunk(SessionId session, HistoryNumber history, Sequence at,
                                           const ChunkKey& key) {
  readers_.load_history_chunk(
      at, key, [this, session, history, key](const Result<ChunkPtr, std::string>& chunk) {
        world_->ground().history_chunk_loaded(session, history, key, chunk, read_clocks());
      });
}

void ServerEnvironment::read_log_marks(SessionId session, const LogMarksRequest& request) {
  readers_.read_log_marks(request, [this, session, request = request.request](
                                       const WorldReaders::FoundLogMarksResult& found) {
    world_->ground().log_marks_read(session, request, found, read_clocks());
  });
}

void ServerEnvironment::find_builds(SessionId session, const BuildsRequest& request) {
  readers_.find_builds(
      request, [this, session, request = request.request](WorldReaders::FoundBuildsResult found) {
        world_->build_reads().found(session, request, std::move(found), read_clocks());
      });
}

void ServerEnvironment::read_build_piece(SessionId session, const BuildPieceRequest& request) {
  readers_.read_build_piece(
      request, [this, session, request = request.request](WorldReaders::BuildPieceResult piece) {
        world_->build_reads().piece_read(session, request, std::move(piece), read_clocks());
      });
}

void ServerEnvironment::verify_build(UploadNumber upload, std::vector<Bytes> parts) {
  readers_.verify_build(
      std::move(parts), [this, upload](WorldReaders::VerifiedBuildResult verified) {
        world_->build_uploads().verified(upload, std::move(verified), read_clocks());
      });
}

bool ServerEnvironment::save_build_file(UploadNumber upload, std::uint64_t content,
                                        std::shared_ptr<const Bytes> file) {
  if (log_ == nullptr) return false;
  // The writer thread calls it. The text for the client names no file of this machine.
  const auto done = [this, upload](const StoreResult<void>& saved) {
    if (!saved) logger("store").warn("a build was not added: {}", saved.error().message());
    strand_.post([this, upload, why = saved ? std::string() : saved.error().what] {
      world_->build_uploads().saved(upload, why, read_clocks());
    });
  };
  return log_->writer().save_build_file(content, std::move(file), done);
}

void ServerEnvironment::remove_build_file(std::uint64_t content) {
  if (log_ != nullptr) log_->writer().remove_build_file(content);
}

void ServerEnvironment::save_snapshots(std::vector<std::pair<ChunkKey, ChunkPtr>> chunks,
                                       Sequence checkpoint) {
  // The checkpointer has one job under way at a time, so the queue of jobs has room unless the
  // writer has failed.
  const bool is_taken = log_->writer().save_snapshots(std::move(chunks), checkpoint);
  RUNSTONE_ASSERT(is_taken || log_->has_failed());
}

void ServerEnvironment::command(SessionId session, AuthorId author, const PublicKey& key,
                                const std::string& text) {
  commands_->run(session, author, key, text);
}

void ServerEnvironment::player_came(const PlayerVisit& visit) {
  const auto& net = sessions_.find(visit.session);
  lines_.write(OperatorLogLevel::info, came_line(visit, net == nullptr ? "-" : net->peer()),
               read_clocks().steady_us);
}

void ServerEnvironment::player_left(const PlayerVisit& visit) {
  const auto& net = sessions_.find(visit.session);
  lines_.write(OperatorLogLevel::info, left_line(visit, net == nullptr ? EndCause{} : net->end()),
               read_clocks().steady_us);
}

void ServerEnvironment::report(OperatorLogLevel level, const std::string& line) {
  lines_.write(level, line, read_clocks().steady_us);
}

}  // namespace runstone
