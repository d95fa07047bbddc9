#include "server/runtime/server_core.hpp"

#include <sodium.h>

#include <algorithm>
#include <chrono>
#include <span>

#include "common/core/version.hpp"
#include "common/core/world_pos.hpp"
#include "common/os/clock_service.hpp"
#include "common/os/process_memory.hpp"
#include "common/os/steady_clock.hpp"
#include "server/admin/command_table.hpp"
#include "server/admin/config_reload.hpp"
#include "server/runtime/counters_line.hpp"
#include "server/runtime/derived_config.hpp"
#include "server/runtime/logging.hpp"
#include "server/runtime/read_clocks.hpp"
#include "server/runtime/recovery.hpp"
#include "server/world/environment/world_border.hpp"
#include "server/world/ground/tile_resends.hpp"

namespace runstone {
namespace {

constexpr auto kTickInterval = std::chrono::milliseconds(50);
constexpr auto kChatRetentionInterval = std::chrono::minutes(10);
constexpr auto kStallInterval = std::chrono::seconds(1);
constexpr auto kCheckpointInterval = std::chrono::seconds(5);
// An owner answers a ping each second.
constexpr TimeUs kOwnerHeardUsMax = 1'500'000;
constexpr TimeUs kWriteBeforeUs = 2'000'000;  // that the log may take before a handover
constexpr TimeUs kTurnsUs = 500;  // that one task spends on messages, but for the last of them

}  // namespace

ServerCore::ServerCore(const ServerThreads& threads, const ServerConfig& config, Store& store,
                       const Generator& generator, std::function<void()> on_failure,
                       OperatorActions actions)
    : io_(threads.io),
      config_(config),
      store_(store),
      generator_(generator),
      on_failure_(std::move(on_failure)),
      actions_(std::move(actions)),
      running_(config),
      strand_(threads.io, [this] { after_task(); }),
      listener_(std::make_shared<Listener>(threads.io, threads.decoders.get_executor(),
                                           net_limits_of(config), store.meta().chunk_edge, *this)),
      sessions_(strand_),
      chunks_(world_place(config), generator),
      sender_(threads.workers, chunks_),
      readers_(strand_, threads.workers, chunks_, world_place(config), generator),
      tiles_(strand_, chunks_, generator, store.meta().chunk_edge,
             [this](Sequence at, const ChunkKey& key) { return readers_.past_chunk(at, key); }),
      owner_(threads.io, strand_, threads.decoders.get_executor(), store.meta().chunk_edge,
             !config.insecure),
      environment_(strand_, sessions_, *listener_, sender_, readers_, tiles_, owner_),
      commits_(strand_, listener_->counters(), [this] { world_->commit_one(read_clocks()); }),
      health_(strand_, threads.workers, world_place(config)),
      tile_resends_(strand_.make_timer()),
      ticks_(strand_, kTickInterval, [this] { tick(); }),
      stalls_(strand_, kStallInterval, [this] { close_stalled(); }),
      activity_(strand_, std::chrono::seconds(config.counters_s), [this] { write_activity(); }),
      chat_retention_(strand_, kChatRetentionInterval,
                      [this] {
                        const TimeUs log_us =
                            world_->rights().time();  // may be ahead of the system's clock
                        chat_log_->forget_before(
                            chat_kept_from_us(config_, std::min(log_us, read_clocks().utc_us)));
                      }),
      checkpoints_(strand_, kCheckpointInterval, [this] { read_checkpoint(); }) {}

ServerCore::~ServerCore() = default;

Result<void, std::string> ServerCore::listen_for_gateway(const std::string& path,
                                                         bool is_for_group) {
  const NetLimits limits = net_limits_of(config_);
  gateway_ = std::make_shared<GatewayListener>(
      io_, std::chrono::milliseconds(limits.handshake_ms),
      [listener = listener_, form = limits.log_addresses](
          asio::local::stream_protocol::socket socket, const asio::ip::tcp::endpoint& client) {
        listener->admit(make_local_stream(std::move(socket), client, form));
      });
  return gateway_->listen(path, is_for_group);
}

Result<void, std::string> ServerCore::recover() {
  auto start = read_world_start(store_);
  if (!start) return failure(start.error());
  clock_evidence_ = read_clock_evidence(world_place(config_), start->log.last_time_us);
  const ClockCheck clock = check_clock(clock_evidence_);
  if (clock.warning) logger("world").warn("{}", *clock.warning);
  start->log.begin_us = clock.begin_us;
  const auto epoch = store_.raise_epoch();
  if (!epoch) return failure(epoch.error().message());
  start->log.epoch = *epoch;
  if (const auto made = make_world(*start); !made) return made;
  make_log(store_, start->log.last);
  logger("world").info("OWNS THE WORLD: epoch={} seq={}", *epoch, start->log.last);
  return {};
}

Result<void, std::string> ServerCore::follow() {
  if (store_.epoch() == 0) return failure("the owner of the world has not started");
  // The owner goes on writing meanwhile.
  if (const auto begun = store_.begin_reads(); !begun) return failure(begun.error().message());
  auto start = read_world_start(store_);
  if (!start) return failure(start.error());
  start->log.epoch = std::max(store_.epoch(), start->log.last_epoch);
  if (const auto made = make_world(*start); !made) return made;
  if (const auto ended = store_.end_reads(); !ended) return failure(ended.error().message());
  world_->cluster().follow();
  return {};
}

Result<void, std::string> ServerCore::make_world(WorldStart& start) {
  chat_log_ = open_chat_log(config_, read_clocks().utc_us);
  if (chat_log_) start.chat = newest_chat(*chat_log_);

  auto materials = store_.materials();
  if (!materials) return failure(materials.error().message());
  WorldConfig world_config = world_config_of(config_, store_.meta(), port());
  world_config.materials = *std::move(materials);
  world_ = std::make_unique<WorldServer>(
      std::move(world_config), start, environment_,
      [](std::span<std::uint8_t> out) { randombytes_buf(out.data(), out.size()); });
  if (config_.border && !holds_voxel(*config_.border, voxel_of_point(store_.meta().spawn))) {
    logger("world").warn(
        "border: the spawn of the world lies outside ({}): players who join there cannot edit",
        border_text(*config_.border));
  }
  const auto replayed = replay_log(store_, start, *world_);
  if (!replayed) return failure(replayed.error());
  environment_.attach(*world_, chat_log_.get());
  owner_.attach(*world_);
  logger("world").info("world={} seq={} checkpoint={} replayed={} players={} snapshots={}",
                       config_.world, start.log.last, start.checkpoint, *replayed,
                       start.players.size(), start.snapshots.size());
  return {};
}

void ServerCore::make_log(Store& store, Sequence durable) {
  if (!commands_) {
    OperatorActions actions = actions_;
    actions.doubt_clock = [this](TimeUs wall_us) {
      ClockEvidence evidence = clock_evidence_;
      evidence.wall_us = wall_us;
      evidence.is_synchronised = is_clock_synchronised();
      return doubt_of_clock_behind(evidence);
    };
    actions.row_faults = [this] { return log_ ? log_->row_faults() : 0; };
    actions.retention_state = [this] { return retention_state(); };
    actions.run_retention = [this](std::uint64_t days) {
      return log_ != nullptr && !log_->has_failed() && log_->retention().run_now(days);
    };
    actions.stop_retention = [this] { return log_ != nullptr && log_->retention().cancel(); };
    actions.health = [this] { return health(); };
    actions.log_line = [](const std::string& line) { logger("app").info("{}", line); };
    // The log writer is another one after each takeover.
    actions.save_build_file = [this](std::uint64_t content, std::shared_ptr<const Bytes> file,
                                     std::function<void(const std::string&)> done) {
      return log_ != nullptr && log_->writer().save_build_file(
                                    content, std::move(file),
                                    [done = std::move(done)](const StoreResult<void>& saved) {
                                      done(saved ? std::string() : saved.error().message());
                                    });
    };
    if (chat_log_) {
      actions.list_chat = [this](const ChatQuery& query, const CommandReply& reply) {
        runstone::list_chat(*chat_log_, query, reply);
      };
    }
    commands_ = std::make_unique<CommandRunner>(strand_, *world_, readers_, running_.operators,
                                                config_.world, actions);
  }
  DurableLog::Options options;
  options.queued_records_max = config_.log_queue_records;
  options.reserve_bytes = config_.disk_reserve_mib << 20;
  options.durable = durable;
  if (config_.keyframe_edits > 0) options.keyframes = KeyframePolicy{config_.keyframe_edits};
  options.checks_rows = true;
  options.retention_days = running_.retention_days;
  // A task that on_space posts from the constructor runs later.
  log_ = std::make_unique<DurableLog>(strand_, store, world_place(config_), generator_, options,
                                      log_events());
  commands_->set_announcements(running_.announcements);
  environment_.attach(*log_, *commands_);
}

Result<void, std::string> ServerCore::take_over(Store& store, const std::string& address) {
  struct Left {
    std::vector<LogPart> parts;
    Version last;
  };
  const auto left = strand_.ask([this] {
    owner_.leave("this server takes the world over");
    return Left{world_->cluster().stop_following(), world_->order().last_record()};
  });
  if (!left) return failure(left.error());
  const auto failed = [this](std::string why) {
    world_->cluster().takeover_failed();
    return failure(std::move(why));
  };
  const auto start = prepare_takeover(store, left->parts, left->last);
  if (!start) return failed(start.error());
  // Now, because the log writer has the store from the next step on. The others connect a moment later.
  if (const auto published = store.publish_address(address); !published)
    return failed(published.error().message());
  const auto is_taken = strand_.ask([this, &store, &start] {
    checkpoints_.stop();
    make_log(store, start->read.last);
    return world_->cluster().take_over(*start, read_clocks());
  });
  if (!is_taken) return failed(is_taken.error());
  if (!*is_taken) {
    log_->stop();
    return failure("the log has other edits than this server");
  }
  logger("world").info("OWNS THE WORLD: epoch={} seq={}", start->epoch, start->read.last);
  return {};
}

Result<SessionId, std::string> ServerCore::begin_handover(std::optional<SessionId> successor) {
  const auto head = strand_.ask([this, successor]() -> Result<Sequence, std::string> {
    if (const auto why = world_->cluster().handover_refusal(successor)) return failure(*why);
    return world_->order().head();
  });
  if (!head) return failure(head.error());
  // Edits go on while the log is written up to now. If that takes long, the pause would be long, too.
  using Written = Result<void, std::string>;
  const TimeUs until_us = steady_now_us() + kWriteBeforeUs;
  const auto written = strand_.ask_until([this, &head, until_us]() -> std::optional<Written> {
    if (log_->durable() >= *head) return Written();
    if (log_->has_failed()) return failure("the log cannot be written");
    if (steady_now_us() >= until_us) return failure("the database takes too long to write the log");
    return std::nullopt;  // the log reports on the strand, which ticks as well
  });
  if (!written) return failure(written.error());
  return strand_.ask([this, successor]() -> Result<SessionId, std::string> {
    if (const auto why = world_->cluster().handover_refusal(successor)) return failure(*why);
    if (!commands_->is_idle())
      return failure("rollbacks or undos are under way: wait, or cancel them (rollback list)");
    world_->save_state(read_clocks());
    return world_->cluster().hand_over(successor, read_clocks());
  });
}

Result<void, std::string> ServerCore::end_handover() {
  log_->stop();
  // The reports of the log are on the strand already.
  auto ended = strand_.ask([this]() -> Result<void, std::string> {
    const LogWriter::Counters counters = log_counters_now();
    if (log_->has_failed() || log_->durable() != world_->order().head() ||
        counters.queued_records > 0)
      return failure("not all edits could be written to the log");
    world_->cluster().handover_written(read_clocks());
    ended_logs_ = counters;
    environment_.detach_log();
    log_.reset();
    checkpoints_.start();
    return {};
  });
  if (!ended) world_->log_failed();
  return ended;
}

ServerCore::FollowState ServerCore::follow_state() const {
  const TimeUs heard_us = owner_heard_us_.load();
  const bool hears_owner = heard_us != 0 && steady_now_us() - heard_us < kOwnerHeardUsMax;
  return {is_live_.load(), hears_owner};
}

void ServerCore::read_checkpoint() {
  const auto checkpoint = std::make_shared<Sequence>(0);
  const auto work = [checkpoint](WorldReader& reader, const Generator& /*generator*/) {
    if (const auto read = reader.checkpoint()) *checkpoint = *read;
  };
  readers_.run_on_log_reader(work, [this, checkpoint](const std::string& /*error*/) {
    world_->cluster().checkpoint_moved(*checkpoint);
  });
}

DurableLog::Events ServerCore::log_events() {
  DurableLog::Events events;
  events.on_durable = [this](Sequence seq) {
    const Clocks now = read_clocks();
    world_->durable(seq, now);
    commands_->tick(now);
  };
  events.on_names_written = [this](std::size_t count) {
    const Clocks now = read_clocks();
    world_->names_durable(count, now);
    commands_->tick(now);
  };
  events.on_snapshots_saved = [this] { world_->snapshots_saved(read_clocks()); };
  events.on_space = [this](DiskSpace space) {
    world_->set_disk_is_full(space != DiskSpace::enough, read_clocks(),
                             space == DiskSpace::read_only ? kDatabaseIsReadOnly : kDiskIsFull);
    commands_->tick(read_clocks());
  };
  events.on_failed = [this] {
    world_->log_failed();
    commands_->tick(read_clocks());
  };
  events.on_failed_in_writer = on_failure_;
  return events;
}

void ServerCore::start() {
  listener_->start();
  if (gateway_) gateway_->start();
  ticks_.start();
  health_.start();
  if (chat_log_) chat_retention_.start();
  stalls_.start();
  if (config_.counters_s > 0) activity_.start();
  if (log_ == nullptr) checkpoints_.start();
}

void ServerCore::tick() {
  const Clocks now = read_clocks();
  world_->tick(now);
  if (commands_) commands_->tick(now);
  if (log_ && commands_) log_->retention().hold(commands_->reads_log());
  if (const auto successor = world_->cluster().take_better_owner()) hand_over_to(*successor);
}

void ServerCore::hand_over_to(SessionId successor) {
  if (!actions_.hand_over) return;
  logger("app").info("move_to_builders: most edits come from server={}: handing the world over",
                     successor);
  actions_.hand_over(successor, [](const CommandAnswer& answer) {
    logger("app").info("move_to_builders: {}", answer.text);
  });
}

void ServerCore::close_stalled() {
  const std::chrono::microseconds idle = std::chrono::seconds(running_.idle_s);
  listener_->close_stalled(steady_now_us(), idle.count());
}

void ServerCore::after_task() {
  const TimeUs now_us = steady_now_us();
  if (world_->has_ready_edits(now_us)) commits_.schedule();
  health_.observe(world_->order().head(), world_->order().durable(), now_us);
  schedule_delivery();
  schedule_tile_resends();
  is_live_.store(world_->cluster().is_live());
  owner_heard_us_.store(world_->cluster().owner_heard_us().value_or(0));
}

void ServerCore::log_counters() {
  // The file of the memory is read here, because the world strand reads no files.
  strand_.post([this, memory_bytes = process_memory_bytes()] {
    logger("app").info("{}", all_counters(memory_bytes));
  });
}

std::string ServerCore::all_counters(std::uint64_t memory_bytes) const {
  RuntimeCounters runtime{sender_.encoded_count(), environment_.enqueue_ns() / 1'000, memory_bytes,
                          dropped_log_lines(), log_ ? log_->row_faults() : 0};
  if (actions_.backup_state) runtime.backups = actions_.backup_state();
  runtime.retention = retention_state();
  runtime.health = health();
  runtime.durable_waits = health_.durable_waits();
  return counters_line(*world_, listener_->counters(), log_counters_now(), runtime);
}

RetentionState ServerCore::retention_state() const {
  RetentionState state;
  state.days = running_.retention_days;
  if (log_) state = log_->retention().state();
  // A log writer counts from its own start, which a takeover makes anew.
  const LogWriter::Counters all = log_counters_now();
  state.edits = all.folded_edits;
  state.parts = all.folds;
  state.writer_us = all.fold_us;
  state.writer_us_max = all.fold_us_max;
  return state;
}

LogWriter::Counters ServerCore::log_counters_now() const {
  LogWriter::Counters all = ended_logs_;
  if (!log_) return all;
  const LogWriter::Counters now = log_->writer().counters();
  all.commits += now.commits;
  all.records += now.records;
  all.snapshots += now.snapshots;
  all.keyframes += now.keyframes;
  all.folds += now.folds;
  all.folded_edits += now.folded_edits;
  all.fold_us += now.fold_us;
  all.fold_us_max = std::max(all.fold_us_max, now.fold_us_max);
  all.queued_records = now.queued_records;
  return all;
}

std::string ServerCore::status_of_follower() const {
  const std::string owner = world_->cluster().is_live()
                                ? "this server follows the owner at " + owner_.address()
                                : "this server waits for an owner of the world";
  return fmt::format("{}\n{}\nsessions {}, edits {} (on disk {})", version_line(health()), owner,
                     world_->session_count(), world_->order().head(), world_->order().durable());
}

void ServerCore::command(const std::string& line, CommandReply reply) {
  strand_.post([this, line, reply = std::move(reply)]() mutable {
    if (!world_->cluster().is_following()) return commands_->run(line, std::move(reply));
    give_command(FollowerCall{actions_, status_of_follower(), std::move(reply)}, line);
  });
}

PageDesk::Server ServerCore::page_server() {
  PageDesk::Server server;
  server.give = [this](const AccessToken& token, const std::string& line,
                       const CommandReply& reply) {
    strand_.post([this, token, line, reply] {
      if (!world_->cluster().is_following()) return commands_->run(token, line, reply);
      refuse(reply, std::string(kPageBarred) + "\n" + kGiveThere);
    });
  };
  server.describe = [this](const AccessToken& token, const CommandReply& reply) {
    strand_.post([this, token, reply] {
      if (!world_->cluster().is_following()) return commands_->describe(token, reply);
      refuse(reply, std::string(kPageBarred) + "\n" + kGiveThere);
    });
  };
  server.rights = [this](const AccessToken& token, std::function<void(RightSet)> then) {
    strand_.post([this, token, then = std::move(then)] {
      then(world_->cluster().is_following() ? RightSet() : commands_->rights_of(token));
    });
  };
  return server;
}

CommandAnswer ServerCore::answer_of(const std::string& line) {
  // Used on the world strand.
  const auto replied = std::make_shared<std::optional<CommandAnswer>>();
  command(line, [replied](const CommandAnswer& answer) {
    if (answer.is_done) *replied = answer;
  });
  const auto answer = strand_.ask_until([replied] { return *replied; });
  return answer ? *answer : CommandAnswer{answer.error(), true, false};
}

void ServerCore::answer_gateway(const std::string& question, CommandReply reply) {
  if (question != "status") return refuse(reply, "the only question is `status`");
  strand_.post([this, memory_bytes = process_memory_bytes(), reply = std::move(reply)] {
    std::string text = all_counters(memory_bytes);
    text += fmt::format("\nversion {}", version());
    if (const std::string why = read_only_reason(world_->order()); !why.empty())
      text += "\nread_only " + why;
    if (world_->border()) text += "\nborder " + border_words(*world_->border());
    for (const auto& player : world_->people().online()) {
      text += "\nplayer " + player.name;
      text += fmt::format("\nplace {:.1f} {:.1f} {:.1f} {}", player.at.x, player.at.y, player.at.z,
                          player.name);
    }
    reply(CommandAnswer::last(std::move(text)));
  });
}

void ServerCore::reload(Result<ServerConfig, std::string> read, CommandReply reply) {
  strand_.post([this, read = std::move(read), reply = std::move(reply)] {
    if (!read) {
      logger("app").error("reload: {}: all settings stay as they were", read.error());
      return refuse(reply, "reload: " + read.error() + ": all settings stay as they were");
    }
    ConfigReload reloaded = reload_config(running_, *read);
    const bool has_new_retention = reloaded.config.retention_days != running_.retention_days &&
                                   reloaded.config.retention_days > 0;
    running_ = std::move(reloaded.config);
    start_logging(running_.log_level, running_.log_format);
    world_->reconfigure(world_config_of(running_, store_.meta(), port()));
    if (commands_) commands_->set_operators(running_.operators);
    if (log_) log_->retention().set_days(running_.retention_days);
    if (commands_) commands_->set_announcements(running_.announcements);
    std::string text = reloaded.text();
    if (has_new_retention)
      text += ". Retention begins in an hour: `retention preview` says what it removes";
    logger("app").info("reload: {}", text);
    reply(CommandAnswer::last(std::move(text)));
  });
}

void ServerCore::write_activity() {
  ActivitySample sample = sample_activity(*world_, listener_->counters(), log_counters_now());
  const ActivityNow now{world_->people().online().size(), world_->order().memory().total()};
  const std::string line = activity_line(sampled_, sample, now, config_.counters_s);
  sampled_ = sample;
  if (!line.empty()) logger("app").info("{}", line);
}

bool ServerCore::stop_world() {
  listener_->stop();
  if (gateway_) gateway_->stop();
  strand_.post([this] {
    owner_.end("this server stops");
    if (commands_) commands_->stop();
    const Clocks now = read_clocks();
    world_->begin_stop(now);
    if (commands_) commands_->tick(now);  // commands that wait get their answer
    // The world has closed the sessions that it knows. These are connected, but their first task
    // has not run.
    listener_->close_all(GoodbyeReason::closing, "the server stops");
  });
  const auto hands_over =
      strand_.ask_until([this] { return finish_stop(); }, WorldStrand::kAnyTime);
  return *hands_over;
}

std::optional<bool> ServerCore::finish_stop() {
  // Sessions end within the linger time of NetSession, which is a second.
  // Another server waits for the world, and not for the sessions here.
  if (!sessions_.is_empty() && !world_->cluster().hands_over()) return std::nullopt;
  const bool gives_up =
      log_ && (log_->has_failed() || (log_->is_full() && world_->order().is_stop_overdue()));
  if (!gives_up && !world_->order().is_flushed()) return std::nullopt;
  ticks_.stop();
  health_.stop();
  stalls_.stop();
  activity_.stop();
  chat_retention_.stop();
  checkpoints_.stop();
  tile_resends_.cancel();
  return world_->cluster().hands_over();
}

StopState ServerCore::stop_state() const {
  if (!log_) return {};
  return {log_->has_failed(), world_->order().head() - log_->durable(),
          world_->order().dirty_chunks()};
}

void ServerCore::stop_writer() {
  readers_.stop();
  tiles_.stop();
  if (chat_log_) chat_log_->stop();
  if (log_) log_->stop();
}

void ServerCore::on_refused(SessionId session) { listener_->forget(session); }

void ServerCore::on_connected(SessionId session, const std::optional<ChannelBinding>& binding) {
  auto net = listener_->find(session);
  logger("net").debug("session={} peer={} connected", session, net->peer());
  strand_.post([this, session, net = std::move(net), binding]() mutable {
    const AddressBlock from = net->address();
    sessions_.add(session, std::move(net));
    world_->connected(session, read_clocks(), from, binding);
  });
}

void ServerCore::on_message(SessionId session, Message&& message, std::size_t bytes) {
  strand_.post([this, session, message = std::move(message), bytes]() mutable {
    messages_.push(session, std::move(message), bytes);
    schedule_turn();
  });
}

void ServerCore::schedule_turn() {
  if (messages_.is_empty() || std::exchange(is_turn_posted_, true)) return;
  strand_.post([this] {
    is_turn_posted_ = false;
    // With many sessions a task waits for the writes of all of them, so each does several turns.
    const TimeUs end_us = steady_now_us() + kTurnsUs;
    do {
      auto turn = messages_.next();
      if (!turn) return;
      handle(*std::move(turn));
    } while (steady_now_us() < end_us);
    schedule_turn();
  });
}

void ServerCore::schedule_delivery() {
  if (!world_->ground().has_deliveries() || std::exchange(is_delivery_posted_, true)) return;
  strand_.post([this] {
    is_delivery_posted_ = false;
    world_->ground().deliver_next(read_clocks());
  });
}

void ServerCore::schedule_tile_resends() {
  if (!world_->ground().has_tile_resends() || std::exchange(is_resend_scheduled_, true)) return;
  tile_resends_.expires_after(std::chrono::microseconds(kTileResendBurstUs));
  strand_.wait(tile_resends_, [this](const asio::error_code& error) {
    is_resend_scheduled_ = false;
    if (!error) world_->ground().resend_tiles(read_clocks());
  });
}

void ServerCore::handle(MessageTurns::Turn&& turn) {
  world_->received(turn.session, std::move(turn.message), read_clocks());
  if (const auto& net = sessions_.find(turn.session)) net->handled(turn.bytes);
}

void ServerCore::on_drained(SessionId session) {
  strand_.post([this, session] { world_->drained(session, read_clocks()); });
}

void ServerCore::on_disconnected(SessionId session) {
  logger("net").debug("session={} disconnected", session);
  listener_->forget(session);
  strand_.post([this, session] {
    while (auto turn = messages_.next_of(session)) handle(*std::move(turn));
    world_->disconnected(session);
    sessions_.remove(session);
  });
}

}  // namespace runstone
