#include "server/runtime/server_core.hpp"

#include <sodium.h>

#include <algorithm>
#include <asio/bind_executor.hpp>
#include <asio/post.hpp>
#include <chrono>
#include <utility>

#include "common/os/steady_clock.hpp"
#include "common/os/thread_cpu_ns.hpp"
#include "common/runs/dense.hpp"
#include "server/admin/operators.hpp"
#include "server/history/missing_edits.hpp"
#include "server/runtime/logging.hpp"

namespace runstone {
namespace {

// Enough that no worker waits for the world strand, few enough that chunks to be encoded do not wait for
// loads.
constexpr std::size_t kLoadsPerWorker = 4;
constexpr auto kTickInterval = std::chrono::milliseconds(50);

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

Clocks now() {
  const auto utc = std::chrono::system_clock::now().time_since_epoch();
  return {steady_now_us(), std::chrono::duration_cast<std::chrono::microseconds>(utc).count()};
}

NetLimits net_limits(const ServerConfig& config) {
  NetLimits limits;
  limits.send.control_bytes = config.control_queue_kib * 1024;
  limits.send.edit_bytes = config.edit_queue_kib * 1024;
  limits.send.chunk_bytes = config.chunk_queue_kib * 1024;
  limits.bytes_per_second = config.session_kib_per_second * 1024;
  limits.server_bytes_per_second = config.server_kib_per_second * 1024;
  limits.read_bytes_per_second = config.read_kib_per_second * 1024;
  limits.connections_max = config.sessions_max + 64;  // some more may be in the handshake
  limits.handshakes_per_address = config.handshakes_per_address;
  limits.messages_per_second = config.messages_per_second;
  limits.message_burst = 2 * config.messages_per_second;
  return limits;
}

}  // namespace

ServerCore::ServerCore(asio::io_context& io, asio::thread_pool& workers, const ServerConfig& config,
                       Store& store, const Generator& generator, std::function<void()> on_failure,
                       std::function<void()> on_stop)
    : workers_(workers),
      config_(config),
      store_(store),
      generator_(generator),
      on_failure_(std::move(on_failure)),
      strand_(asio::make_strand(io)),
      tick_(strand_),
      gather_(strand_),
      listener_(std::make_shared<Listener>(io, net_limits(config), store.meta().chunk_edge, *this)),
      on_stop_(std::move(on_stop)) {}

ServerCore::~ServerCore() = default;

// ---- start
// ---------------------------------------------------------------------------------------------------

WorldConfig ServerCore::world_config(const ServerConfig& config) const {
  const WorldMeta& meta = store_.meta();
  WorldConfig world;
  world.world_id = meta.world_id;
  world.chunk_edge = meta.chunk_edge;
  world.heights = {-static_cast<std::int32_t>(config.depth_max),
                   static_cast<std::int32_t>(config.height_max)};
  world.spawn = meta.spawn;
  world.materials = meta.materials;
  world.server_keys = key_pair_of(meta.server_key_seed);
  world.sessions_max = config.sessions_max;
  world.view_radius_max = static_cast<std::uint8_t>(config.view_radius_max);
  world.view_interval_us = static_cast<TimeUs>(config.view_interval_ms) * 1'000;
  world.loads_in_flight_max = kLoadsPerWorker * config.worker_threads;
  world.edit_volume_max = config.edit_volume_max;
  world.reach_max = static_cast<double>(config.reach_max);
  world.edits_per_second = config.edits_per_second;
  world.edit_burst = config.edit_burst;
  world.idle_us_max = static_cast<TimeUs>(config.idle_s) * 1'000'000;
  world.preferred_encoding = config.encoding == "raw"     ? ChunkEncoding::raw
                             : config.encoding == "coded" ? ChunkEncoding::coded
                                                          : ChunkEncoding::packed;
  world.audit_interval_us = static_cast<TimeUs>(config.audit_ms) * 1'000;
  world.audit_chunks = config.audit_chunks;
  world.resident_bytes_max = config.memory_mib << 20;
  world.snapshots.edits_max = config.snapshot_edits;
  world.snapshots.interval_us = static_cast<TimeUs>(config.snapshot_s) * 1'000'000;
  return world;
}

Result<WorldStart, std::string> ServerCore::read_start() {
  WorldStart start;
  const auto failure = [](const StoreError& error) {
    return Unexpected<std::string>{error.message()};
  };
  const auto range = store_.log_range();
  if (!range) return failure(range.error());
  start.log.last = range->last.version.seq;
  start.log.last_time_us = range->last.time_us;
  // No edit of this run may be stamped by a damaged time: the last row's checksum vouches for it.
  const auto last_row =
      store_.read_log(start.log.last, start.log.last, [](const EditRecord&) { return true; });
  if (!last_row) return failure(last_row.error());
  const auto checkpoint = store_.checkpoint();
  if (!checkpoint) return failure(checkpoint.error());
  start.checkpoint = *checkpoint;
  auto snapshots = store_.snapshot_keys();
  if (!snapshots) return failure(snapshots.error());
  start.snapshots = *std::move(snapshots);
  auto players = store_.players();
  if (!players) return failure(players.error());
  start.players = *std::move(players);
  auto marks = store_.high_waters();
  if (!marks) return failure(marks.error());
  start.resolved = *std::move(marks);
  return start;
}

Result<void, std::string> ServerCore::recover(const std::string& folder) {
  auto start = read_start();
  if (!start) return Unexpected<std::string>{start.error()};
  const auto epoch = store_.raise_epoch();
  if (!epoch) return Unexpected<std::string>{epoch.error().message()};
  start->log.epoch = *epoch;

  world_ = std::make_unique<WorldServer>(
      world_config(config_), *start, *this,
      [](std::span<std::uint8_t> out) { randombytes_buf(out.data(), out.size()); });
  std::uint64_t restacked = 0;
  const auto read =
      store_.read_log(start->checkpoint + 1, start->log.last, [&](const EditRecord& record) {
        world_->replay_onto_stack(record);
        ++restacked;
        return true;
      });
  if (!read) return Unexpected<std::string>{read.error().message()};
  const auto operators = parse_operators(config_.operators);
  if (!operators) return Unexpected<std::string>{"operators: " + operators.error()};
  operators_ = *operators;
  rollback_ = std::make_unique<RollbackService>(
      *world_, *this, [](std::span<std::uint8_t> out) { randombytes_buf(out.data(), out.size()); });
  commands_ = std::make_unique<CommandHandler>(*world_, *rollback_, *this, store_.meta().materials,
                                               folder, on_stop_);
  durable_.store(start->log.last);
  chunks_ = std::make_unique<ChunkSource>(folder, generator_);
  moments_ = std::make_unique<Moments>(folder, generator_);
  start_writer(folder);
  logger("world").info(
      "world={} epoch={} seq={} checkpoint={} restacked={} players={} snapshots={}", folder, *epoch,
      start->log.last, start->checkpoint, restacked, start->players.size(),
      start->snapshots.size());
  return {};
}

void ServerCore::start_writer(const std::string& folder) {
  LogWriter::Callbacks callbacks;
  callbacks.on_durable = [this](Sequence seq) {
    durable_.store(seq);
    if (keyframes_) keyframes_->durable(seq);
    // One post at a time: under load several group commits become one watermark.
    if (durable_posted_.exchange(true)) return;
    asio::post(strand_, [this] {
      durable_posted_.store(false);
      world_->durable(durable_.load(), now());
      rollback_->tick(now());
      check_settled();
    });
  };
  callbacks.on_snapshots_saved = [this](const LogWriter::SnapshotChunks& /*chunks*/,
                                        std::optional<Sequence> /*seq*/) {
    asio::post(strand_, [this] {
      world_->snapshots_saved(now());
      check_settled();
    });
  };
  callbacks.on_failed = [this](const StoreError& error) {
    logger("store").error("{}", error.message());
    failed_.store(true);
    asio::post(strand_, [this] {
      world_->log_failed();
      rollback_->tick(now());
      check_settled();
    });
    on_failure_();
  };
  LogWriter::Limits limits;
  limits.queued_records_max = config_.log_queue_records;
  writer_ = std::make_unique<LogWriter>(store_, std::move(callbacks), limits);
  // Before anybody can append: the writer's callbacks see it.
  if (config_.keyframe_edits > 0) {
    const KeyframePolicy policy{config_.keyframe_edits};
    keyframes_ = std::make_unique<KeyframeThread>(folder, generator_, policy, *writer_);
  }
}

void ServerCore::start() {
  listener_->start();
  asio::post(strand_, [this] { schedule_tick(); });
}

// ---- turns of the world strand
// ---------------------------------------------------------------------------------

void ServerCore::schedule_commit() {
  if (!world_->has_queued() || std::exchange(commit_posted_, true)) return;
  const TimeUs now_us = steady_now_us();
  const NetCounters& net = listener_->counters();
  const CommitSending sending{net.commit_send_ns.load() / 1'000, net.commit_sends.load(),
                              net.commits_due.load()};
  const TimeUs due_us = commit_pace_.due(now_us, sending);
  if (due_us <= now_us) {
    // Runs behind everything that is queued on the strand now: edits that arrived together become one commit.
    asio::post(strand_, [this] { commit_now(); });
    return;
  }
  gather_.expires_after(std::chrono::microseconds(due_us - now_us));
  gather_.async_wait(
      asio::bind_executor(strand_, [this](const asio::error_code&) { commit_now(); }));
}

void ServerCore::commit_now() {
  commit_posted_ = false;
  world_->commit(now());
}

void ServerCore::schedule_tick() {
  if (has_stopped_) return;
  tick_.expires_after(kTickInterval);
  tick_.async_wait(asio::bind_executor(strand_, [this](const asio::error_code& error) {
    if (error) return;
    const Clocks at = now();
    world_->tick(at);
    rollback_->tick(at);
    check_settled();
    if (config_.counters_s > 0 &&
        at.steady_us - counters_us_ >= static_cast<TimeUs>(config_.counters_s) * 1'000'000) {
      if (counters_us_ != 0) log_counters();
      counters_us_ = at.steady_us;
    }
    schedule_tick();
  }));
}

void ServerCore::log_counters() {
  asio::post(strand_, [this] {
    const WorldCounters& w = world_->counters();
    const NetCounters& n = listener_->counters();
    const LogWriter::Counters l = writer_->counters();
    logger("app").info(
        "counters sessions={} opened={} closed={} malformed={} edits_ordered={} edits_rejected={} "
        "commits={} "
        "seq={} "
        "durable={} checkpoint={} log_queue={} group_commits={} snapshots_written={} keyframes={} "
        "chunks_resident={} "
        "resident_bytes={} chunks_failed={} snapshots_sent={} snapshots_encoded={} same_sent={} "
        "updates_sent={} claims_drifted={} "
        "chunks_requested={} unavailable_sent={} chunks_stale={} "
        "queue_full={} audits_sent={} "
        "audit_mismatches={} commits_sent={} commit_enqueue_us={} commit_sends={} "
        "commit_send_ms={} "
        "bytes_in={} bytes_out={} stack_depths=\"{}\" "
        "dense_expansions={}",
        world_->session_count(), w.sessions_opened, w.sessions_closed, n.malformed.load(),
        w.edits_ordered, w.edits_rejected, w.commits, world_->head(), world_->durable(),
        world_->checkpoint(), l.queued_records, l.commits, l.snapshots, l.keyframes,
        world_->resident_chunks(), world_->resident_bytes(), w.chunks_failed, w.snapshots_sent,
        encoded_.encoded(), w.same_sent, w.updates_sent, w.claims_drifted, w.chunks_requested,
        w.unavailable_sent, w.chunks_stale, w.queue_full, w.audits_sent, w.audit_mismatches,
        w.commits_sent, enqueue_ns_ / 1'000, n.commit_sends.load(),
        n.commit_send_ns.load() / 1'000'000, n.bytes_in.load(), n.bytes_out.load(),
        world_->stack_depths().text(), dense_expansions());
  });
}

// ---- stop
// ------------------------------------------------------------------------------------------------------

std::future<bool> ServerCore::begin_stop() {
  listener_->stop();
  auto stopped = std::make_shared<std::promise<bool>>();
  std::future<bool> answer = stopped->get_future();
  asio::post(strand_, [this, stopped] {
    stopped_ = std::move(*stopped);
    rollback_->stop();
    world_->begin_stop(now());
    rollback_->tick(now());  // whoever waits is told
    listener_->close_all(GoodbyeReason::closing,
                         "the server stops");  // those that have not said hello yet
    check_settled();
  });
  return answer;
}

void ServerCore::check_settled() {
  if (!stopped_ || !sessions_.empty()) return;
  if (!failed_.load() && !world_->is_settled()) return;
  has_stopped_ = true;
  tick_.cancel();
  stopped_->set_value(!failed_.load());
  stopped_.reset();
}

void ServerCore::stop_writer() {
  log_readers_.join();
  past_readers_.join();
  if (keyframes_) keyframes_->stop();
  writer_->stop();
}

// ---- commands
// --------------------------------------------------------------------------------------------------

void ServerCore::command(const std::string& line, CommandReply reply) {
  asio::post(strand_, [this, line, reply = std::move(reply)] {
    commands_->run({0, true}, line, now(), reply);
    rollback_->tick(now());
  });
}

void ServerCore::command(SessionId session, AuthorId author, const PublicKey& key,
                         const std::string& text) {
  const CommandCaller caller{author, operators_.contains(key)};
  if (caller.is_operator) logger("app").info("operator author={} command=\"{}\"", author, text);
  // Ports do not call back in: the answer may come at once.
  asio::post(strand_, [this, session, caller, text] {
    const auto reply = [this, session](const CommandAnswer& answer) {
      world_->answer_command(session, lines_of(answer.text), answer.is_done, answer.is_ok);
    };
    commands_->run(caller, text, now(), reply);
    rollback_->tick(now());
  });
}

void ServerCore::run(Work work, std::function<void(std::string)> then) {
  asio::post(log_readers_, [this, work = std::move(work), then = std::move(then)] {
    const auto read = chunks_->with_reader([&](WorldReader& reader) { work(reader, generator_); });
    asio::post(strand_, [this, then, error = read ? std::string() : read.error().message()] {
      then(error);
      rollback_->tick(now());
    });
  });
}

// ---- NetEvents
// ---------------------------------------------------------------------------------------------------

void ServerCore::on_connected(SessionId session) {
  auto net = listener_->find(session);
  logger("net").debug("session={} peer={} connected", session, net->peer());
  asio::post(strand_, [this, session, net = std::move(net)]() mutable {
    sessions_.emplace(session, std::move(net));
    world_->connected(session, now());
  });
}

void ServerCore::on_message(SessionId session, Message&& message, std::size_t bytes) {
  asio::post(strand_, [this, session, message = std::move(message), bytes]() mutable {
    world_->received(session, std::move(message), now());
    if (NetSession* net = find(session)) net->handled(bytes);
    schedule_commit();
  });
}

void ServerCore::on_drained(SessionId session) {
  asio::post(strand_, [this, session] { world_->drained(session, now()); });
}

void ServerCore::on_disconnected(SessionId session) {
  logger("net").debug("session={} disconnected", session);
  listener_->forget(session);
  asio::post(strand_, [this, session] {
    world_->disconnected(session);
    sessions_.erase(session);
    check_settled();
  });
}

// ---- WorldEnvironment
// --------------------------------------------------------------------------------------------------

NetSession* ServerCore::find(SessionId session) {
  RUNSTONE_ASSERT(strand_.running_in_this_thread());
  const auto found = sessions_.find(session);
  return found == sessions_.end() ? nullptr : found->second.get();
}

bool ServerCore::send(SessionId session, const EncodedMessage& message) {
  NetSession* net = find(session);
  return net == nullptr || net->send(message);  // to one who is gone everything fits
}

std::vector<SessionId> ServerCore::send_to_all(std::span<const SessionId> sessions,
                                               const EncodedMessage& message) {
  const std::int64_t began_ns = thread_cpu_ns();
  std::vector<SessionId> full = WorldEnvironment::send_to_all(sessions, message);
  enqueue_ns_ += thread_cpu_ns() - began_ns;
  return full;
}

void ServerCore::set_encoding(SessionId session, ChunkEncoding encoding) {
  if (NetSession* net = find(session)) net->set_encoding(encoding);
}

void ServerCore::set_features(SessionId session, std::uint64_t features) {
  if (NetSession* net = find(session)) net->set_features(features);
}

void ServerCore::opened(SessionId session) { listener_->opened(session); }

bool ServerCore::send_snapshot(SessionId session, const ChunkKey& key, const ChunkPtr& chunk) {
  const auto found = sessions_.find(session);
  if (found == sessions_.end()) return true;
  const auto place = found->second->reserve_chunk(key);
  if (!place) return false;
  asio::post(workers_, [this, net = found->second, key, chunk, place = *place] {
    net->fill_chunk(place, encoded_.snapshot(key, chunk, net->encoding()));
  });
  return true;
}

bool ServerCore::send_update(SessionId session, const ChunkKey& key, const ChunkPtr& chunk,
                             Version held) {
  const auto found = sessions_.find(session);
  if (found == sessions_.end()) return true;
  const auto place = found->second->reserve_chunk(key);
  if (!place) return false;
  asio::post(workers_, [this, net = found->second, key, chunk, held, place = *place] {
    const ChunkEncoding encoding = net->encoding();
    std::optional<ChunkEdits> edits;
    const auto read = chunks_->with_reader([&](WorldReader& reader) {
      auto missing =
          missing_edits(reader, key, *chunk, held, chunk_bytes_about(chunk->voxels, encoding));
      if (missing) {
        edits = *std::move(missing);
      } else {
        logger("store").error("{}", missing.error().message());
      }
    });
    if (!read) logger("store").error("{}", read.error().message());
    net->fill_chunk(place,
                    edits ? encode_message(*edits) : encoded_.snapshot(key, chunk, encoding));
  });
  return true;
}

void ServerCore::forget_outside(SessionId session, const View& view) {
  if (NetSession* net = find(session)) net->forget_outside(view);
}

void ServerCore::close(SessionId session, GoodbyeReason reason, const std::string& text) {
  if (NetSession* net = find(session)) net->close(reason, text);
}

bool ServerCore::log_has_room(std::size_t records) const { return writer_->has_room(records); }

void ServerCore::log_append(std::vector<PlayerRow> players, std::vector<EditRecord> records) {
  writer_->append(std::move(players), std::move(records));
}

void ServerCore::load_chunk(const ChunkKey& key) {
  RUNSTONE_ASSERT(strand_.running_in_this_thread());
  asio::post(workers_, [this, key] {
    auto loaded = chunks_->load(key);
    asio::post(strand_, [this, key, loaded = std::move(loaded)]() mutable {
      if (loaded) {
        world_->chunk_loaded(key, *std::move(loaded), now());
      } else {
        world_->chunk_failed(key, loaded.error().message(), now());
      }
      check_settled();
    });
  });
}

void ServerCore::open_moment(SessionId session, const HistoryRequest& travel) {
  asio::post(past_readers_, [this, session, travel] {
    const auto end = travel.to == HistoryTarget::time ? moments_->open_at_time(travel.utc_us)
                                                      : moments_->open(travel.seq);
    Result<OpenedMoment, std::string> opened = OpenedMoment{};
    if (end) {
      opened = OpenedMoment{end->version.seq, end->time_us};
    } else {
      if (end.error().kind != StoreError::Kind::bad_request)
        logger("store").error("{}", end.error().message());
      opened =
          Unexpected<std::string>{end.error().what};  // not where on this machine the world lies
    }
    asio::post(strand_, [this, session, request = travel.request, opened = std::move(opened)] {
      world_->moment_opened(session, request, opened, now());
    });
  });
}

void ServerCore::load_past_chunk(SessionId session, std::uint32_t request, Sequence at,
                                 const ChunkKey& key) {
  asio::post(past_readers_, [this, session, request, at, key] {
    auto loaded = moments_->chunk(at, key);
    Result<ChunkPtr, std::string> chunk = ChunkPtr();
    if (loaded) {
      chunk = std::make_shared<const Chunk>(*std::move(loaded));
    } else {
      chunk = Unexpected<std::string>{loaded.error().message()};
    }
    asio::post(strand_, [this, session, request, key, chunk = std::move(chunk)] {
      world_->past_chunk(session, request, key, chunk, now());
    });
  });
}

void ServerCore::save_snapshots(std::vector<std::pair<ChunkKey, ChunkPtr>> chunks,
                                Sequence checkpoint) {
  // The keeper has one job under way at a time, so the queue of jobs has room unless the writer has failed.
  const bool taken = writer_->save_snapshots(std::move(chunks), checkpoint);
  RUNSTONE_ASSERT(taken || failed_.load());
}

void ServerCore::log(WorldLogLevel level, const std::string& line) {
  spdlog::logger& world = logger("world");
  switch (level) {
    case WorldLogLevel::debug:
      world.debug("{}", line);
      break;
    case WorldLogLevel::info:
      if (const auto left_out = infos_.take(now().steady_us))
        world.info("{} left_out={}", line, *left_out);
      break;
    case WorldLogLevel::warn:
      if (const auto left_out = warnings_.take(now().steady_us))
        world.warn("{} left_out={}", line, *left_out);
      break;
    case WorldLogLevel::error:
      world.error("{}", line);
      break;
  }
}

}  // namespace runstone
