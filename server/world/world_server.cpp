#include "server/world/world_server.hpp"

#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "common/core/assert.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"

namespace runstone {

/// The rooms, each above those that it uses.
struct WorldServer::Rooms {
  Rooms(WorldConfig config_, const WorldStart& start, WorldEnvironment& environment_,
        const RandomBytes& random)
      : config(std::move(config_)),
        environment(environment_),
        sessions(environment, counters),
        order(config, start, environment, counters, random),
        receipts(config, sessions, order),
        rights(config, start, order, sessions),
        quotas(config, rights),
        ground(config, environment, counters, sessions, order, rights, quotas),
        commits(config, counters, sessions, order, receipts, rights, ground),
        changes(config, sessions, order, rights, quotas, commits),
        people({config, environment, counters, sessions, order, receipts, rights, quotas, ground,
                changes},
               start, random),
        cluster(
            {config, environment, counters, sessions, order, receipts, commits, people.joining(),
             people.edits(), people.presence(), people.chat(), people.visits(), people.places()},
            random),
        build_reads(config, environment, sessions, order, rights),
        build_uploads({environment, sessions, order, rights, changes, cluster}),
        textures(sessions, order),
        saved(start.saved) {}

  WorldConfig config;
  WorldEnvironment& environment;
  WorldCounters counters;
  Sessions sessions;
  Order order;
  Receipts receipts;
  Rights rights;
  Quotas quotas;
  Ground ground;
  Commits commits;
  Changes changes;
  People people;
  Cluster cluster;
  BuildReads build_reads;
  BuildUploads build_uploads;
  TextureSending textures;
  SavedState saved;     // what was queued last for the store, or was there at the start
  TimeUs saved_us = 0;  // when save_state() was called last; steady clock
  std::optional<WorldPos> set_spawn;  // since the start, or since another server owned the world
};

namespace {

constexpr TimeUs kSaveStateUs = 60'000'000;

/// A kind of message that does not reach OpenMessages: servers send it, or it was handled before.
template <class Kind>
concept HandledBefore = !may_send(info_of(kKindOf<Kind>), Sender::client) ||
                        info_of(kKindOf<Kind>).stage != SessionStage::open ||
                        info_of(kKindOf<Kind>).feature == kFeatureServers ||
                        std::same_as<Kind, Resumed> || std::same_as<Kind, ReceiveAck>;

/// Passes the message of an open session to the room that handles it.
struct OpenMessages {
  Sessions& sessions;
  Ground& ground;
  People& people;
  Cluster& cluster;
  BuildReads& build_reads;
  BuildUploads& build_uploads;
  TextureSending& textures;
  Session& session;
  const Clocks& now;
  void operator()(const View& view) const { ground.on_view(session, view, now); }
  void operator()(const CachedChunks& held) const { ground.on_cached_chunks(session, held); }
  void operator()(const ChunkRequest& request) const {
    ground.on_chunk_request(session, request, now);
  }
  void operator()(const HistoryRequest& request) const {
    ground.on_history_request(session, request, now);
  }
  void operator()(const LogMarksRequest& request) const {
    ground.on_log_marks_request(session, request, now);
  }
  void operator()(const EditRequest& edit) const {
    if (people.edits().on_edit(session, edit, now)) cluster.count_edit(session);
  }
  void operator()(const Move& move) const { people.presence().on_move(session, move, now); }
  void operator()(const CommandRequest& command) const {
    people.commands().on_command(session, command, now);
  }
  void operator()(const ChatRequest& line) const { people.chat().on_line(session, line, now); }
  void operator()(const PreviewShare& share) const {
    people.previews().on_share(session, share, now);
  }
  void operator()(const BuildsRequest& request) const {
    build_reads.on_request(session, request, now);
  }
  void operator()(const BuildPieceRequest& request) const {
    build_reads.on_piece_request(session, request, now);
  }
  void operator()(const BuildOffer& offer) const { build_uploads.on_offer(session, offer, now); }
  void operator()(const BuildUpload& upload) const {
    build_uploads.on_upload(session, upload, now);
  }
  void operator()(const TexturesWanted& wanted) const { textures.on_wanted(session, wanted); }
  void operator()(const Ping& ping) const {
    sessions.send_or_skip(session, encode_message(Pong{ping.sent_us, now.steady_us}));
  }
  // A kind that a client may send, and for which no function stands here, does not compile.
  void operator()(const HandledBefore auto& /*message*/) const {}
};

}  // namespace

WorldServer::WorldServer(WorldConfig config, const WorldStart& start, WorldEnvironment& environment,
                         RandomBytes random)
    : rooms_(std::make_unique<Rooms>(std::move(config), start, environment, random)) {}
WorldServer::~WorldServer() = default;

const Order& WorldServer::order() const { return rooms_->order; }
const Rights& WorldServer::rights() const { return rooms_->rights; }
Changes& WorldServer::changes() { return rooms_->changes; }
Ground& WorldServer::ground() { return rooms_->ground; }
const Ground& WorldServer::ground() const { return rooms_->ground; }
People& WorldServer::people() { return rooms_->people; }
const People& WorldServer::people() const { return rooms_->people; }
Cluster& WorldServer::cluster() { return rooms_->cluster; }
const Cluster& WorldServer::cluster() const { return rooms_->cluster; }
BuildReads& WorldServer::build_reads() { return rooms_->build_reads; }
BuildUploads& WorldServer::build_uploads() { return rooms_->build_uploads; }
const WorldCounters& WorldServer::counters() const { return rooms_->counters; }
const std::optional<WorldBorder>& WorldServer::border() const { return rooms_->config.border; }
const WorldPos& WorldServer::spawn() const { return rooms_->config.spawn; }
std::size_t WorldServer::session_count() const { return rooms_->sessions.count(); }

void WorldServer::replay_onto_stack(const EditRecord& record) {
  const WorldConfig& config = rooms_->config;
  rooms_->order.authority().replay_onto_stack(record);
  if (config.tile_levels_max == 0 || !has_voxels(record.edit)) return;
  std::vector<ChunkKey> keys;
  for (const ChunkCoord at : touched_chunks(record.edit, config.chunk_edge))
    keys.push_back({0, at});
  rooms_->environment.tiles_edited(keys, record.version.seq);
}

void WorldServer::reconfigure(const WorldConfig& config) {
  WorldConfig& mine = rooms_->config;
  mine.sessions_per_key = config.sessions_per_key;
  mine.sessions_per_address = config.sessions_per_address;
  mine.range_seats_percent = config.range_seats_percent;
  mine.idle_us_max = config.idle_us_max;
  mine.border = config.border;
  mine.reach_max = config.reach_max;
  mine.speed_max = config.speed_max;
  mine.operators = config.operators;
  mine.link_address = config.link_address;
  mine.message_of_the_day = config.message_of_the_day;
  mine.move_to_builders = config.move_to_builders;
  rooms_->rights.settings_changed();
  rooms_->ground.rights_changed({});
}

void WorldServer::remove_closed() {
  const std::vector<Session*>& closed = rooms_->sessions.closed();
  for (std::size_t i = 0; i < closed.size(); ++i) {
    const Session& session = *closed[i];
    rooms_->ground.forget(session);
    rooms_->people.forget(session);
    rooms_->cluster.forget(session);
    rooms_->build_reads.forget(session.id);
    rooms_->build_uploads.forget(session.id);
    rooms_->textures.forget(session.id);
    rooms_->receipts.forget(session.id);
  }
  rooms_->sessions.remove_closed();
}

void WorldServer::connected(SessionId session, const Clocks& now, AddressBlock from,
                            const std::optional<ChannelBinding>& binding) {
  Session& fresh = rooms_->sessions.add(session, now.steady_us);
  fresh.address = from;
  fresh.binding = binding;
  if (rooms_->order.is_stopping())
    rooms_->sessions.close(fresh, GoodbyeReason::closing, "the server stops");
  remove_closed();
}

void WorldServer::handle(Session& session, Message&& message, const Clocks& now) {
  if (rooms_->cluster.on_message_for_owner(session, message, now)) return;
  std::visit(
      OpenMessages{rooms_->sessions, rooms_->ground, rooms_->people, rooms_->cluster,
                   rooms_->build_reads, rooms_->build_uploads, rooms_->textures, session, now},
      message);
}

void WorldServer::authenticate(Session& session, const ClientAuth& auth, const Clocks& now) {
  Joining& joining = rooms_->people.joining();
  if (!joining.proves_key(session, auth)) return;
  if (joining.is_server(session)) {
    // The time may have been corrected since its hello.
    if (joining.close_if_old_server(session)) return;
    return rooms_->cluster.admit_follower(session, now);
  }
  if (rooms_->cluster.is_following()) return rooms_->cluster.join_at_owner(session, auth);
  joining.let_in(session, {auth.ticket, auth.password_key}, now);
}

void WorldServer::received(SessionId from, Message&& message, const Clocks& now) {
  Cluster& cluster = rooms_->cluster;
  Joining& joining = rooms_->people.joining();
  if (cluster.is_follower(from)) {
    if (auto relayed = cluster.follower_received(from, message, now))
      handle(relayed->session, std::move(relayed->message), now);
    return remove_closed();
  }
  Session* const session = rooms_->sessions.find(from);
  if (session == nullptr) return;
  ++rooms_->counters.messages;
  session->last_message_us = now.steady_us;
  if (std::holds_alternative<Goodbye>(message)) {
    rooms_->sessions.close(*session, GoodbyeReason::closing, "the client said goodbye");
  } else if (const auto refusal =
                 refusal_of(info_of(message), Sender::client, session->stage, session->features)) {
    rooms_->sessions.close(*session, refusal->reason, refusal->text);
  } else if (const auto* hello = std::get_if<Hello>(&message)) {
    joining.on_hello(*session, *hello);
  } else if (const auto* auth = std::get_if<ClientAuth>(&message)) {
    authenticate(*session, *auth, now);
  } else if (const auto* request = std::get_if<KeyRequest>(&message)) {
    joining.on_key_request(*session, *request, now);
  } else if (const auto* deposit = std::get_if<KeyDeposit>(&message)) {
    joining.on_key_deposit(*session, *deposit, now);
  } else if (std::holds_alternative<Resumed>(message)) {
    cluster.on_resumed(*session);
  } else if (!std::holds_alternative<EditRequest>(message) || !cluster.ignores_edits(*session)) {
    handle(*session, std::move(message), now);
  }
  remove_closed();
}

void WorldServer::disconnected(SessionId session) {
  rooms_->cluster.forget_follower(session);
  if (Session* const gone = rooms_->sessions.find(session)) rooms_->sessions.leave(*gone);
  remove_closed();
  rooms_->ground.collect_released();
}

void WorldServer::drained(SessionId session, const Clocks& now) {
  Session* const mine = rooms_->sessions.find(session);
  if (mine == nullptr) return;
  rooms_->receipts.send_pending(*mine);
  rooms_->textures.drained(*mine);
  rooms_->ground.drained(*mine, now);
  remove_closed();
}

bool WorldServer::has_ready_edits(TimeUs now_us) const {
  return rooms_->commits.has_ready_edits(now_us);
}

void WorldServer::commit_one(const Clocks& now) {
  rooms_->commits.commit(LargeEdits::paced, now);
  remove_closed();
}

void WorldServer::commit(const Clocks& now) {
  rooms_->commits.commit_all(LargeEdits::paced, now);
  remove_closed();
}

void WorldServer::step_checkpointer(const Clocks& now) {
  if (rooms_->order.is_stop_due(now.steady_us)) rooms_->ground.cancel_loads_for_world();
  for (const ChunkKey& key : rooms_->order.step_checkpointer(now))
    rooms_->ground.request_load(key, now);
}

void WorldServer::save_state(TimeUs now_us, TimeUs clock_us) {
  rooms_->saved_us = now_us;
  if (!rooms_->order.owns_world()) return;
  rooms_->people.note_places();
  SavedState state{rooms_->people.places().all(), rooms_->order.clock().saved_at(clock_us),
                   rooms_->set_spawn};
  if (state == rooms_->saved) return;
  if (rooms_->environment.save_state(state)) rooms_->saved = std::move(state);
}

void WorldServer::set_spawn(const WorldPos& spawn, const Clocks& now) {
  rooms_->config.spawn = spawn;
  rooms_->set_spawn = spawn;
  save_state(now.steady_us, now.steady_us + kSaveStateUs);
}

void WorldServer::save_state(const Clocks& now) { save_state(now.steady_us, now.steady_us); }

void WorldServer::tick(const Clocks& now) {
  Cluster& cluster = rooms_->cluster;
  Ground& ground = rooms_->ground;
  People& people = rooms_->people;
  rooms_->order.clock().begin(now.steady_us);
  people.edits().step(now, [&](const Session& session) { cluster.count_edit(session); });
  commit_one(now);
  if (!cluster.is_following()) {
    const auto news = rooms_->changes.accept_kept_jump(cluster.correction_refusal(), now);
    if (news) rooms_->environment.report(OperatorLogLevel::warn, *news);
  }
  if (const auto warning = rooms_->order.authority().log_clock().take_warning())
    rooms_->environment.report(OperatorLogLevel::warn, *warning);
  if (const auto ended = rooms_->rights.end_grants(); !ended.empty()) {
    rooms_->rights.close_refused();
    ground.rights_changed({});
    if (!cluster.is_following()) people.grants_ended(ended, now);  // the owner informs all players
  }
  // Another server may set the spawn from now on. A state that this server saves later must not
  // overwrite it.
  if (cluster.is_following()) rooms_->set_spawn.reset();
  people.forget_gone_authors();
  people.close_silent(now);
  cluster.check_connections(now);
  remove_closed();
  ground.apply_views(now);
  if (!cluster.is_following()) {  // the owner of the world sends them
    people.presence().broadcast_player_list();
    people.visits().tick(now);
    people.chat().broadcast();
    people.presence().broadcast_poses(now);
    cluster.tick_owner(now);
  }
  cluster.send_servers();
  rooms_->receipts.broadcast_durable(now);
  ground.serve_waiting(now);
  for (Session* session : rooms_->sessions.open()) {
    rooms_->receipts.send_pending(*session);
    ground.retry(*session, now);
  }
  rooms_->build_reads.serve(now);
  rooms_->build_uploads.tick(now);
  rooms_->textures.tick();
  // The clock is saved as it will be at the next save: after a crash it never goes back. For the
  // same reason a clock that a new record has set is saved at once: that record has the time of its
  // setting, from which the clock has run on.
  const std::optional<SavedClock>& saved = rooms_->saved.clock;
  const Sequence record = rooms_->order.clock().record();
  const bool is_set_anew = record != (saved ? saved->record : 0);
  if (is_set_anew || now.steady_us - rooms_->saved_us >= kSaveStateUs)
    save_state(now.steady_us, now.steady_us + kSaveStateUs);
  step_checkpointer(now);
  remove_closed();
  ground.start_work(now);
}

void WorldServer::chunk_loaded(const ChunkKey& key, Chunk chunk, const Clocks& now) {
  if (rooms_->ground.chunk_loaded(key, std::move(chunk), now)) step_checkpointer(now);
  rooms_->ground.start_loads(now);
}

void WorldServer::chunk_failed(const ChunkKey& key, LoadFailure failure, const std::string& what,
                               const Clocks& now) {
  if (rooms_->ground.chunk_failed(key, failure, what, now)) step_checkpointer(now);
  rooms_->ground.start_loads(now);
}

void WorldServer::durable(Sequence seq, const Clocks& now) {
  if (!rooms_->order.set_durable(seq)) return;
  rooms_->receipts.send_durable_to_authors();
  rooms_->cluster.send_durable_to_followers();
  rooms_->build_uploads.send_durable();
  step_checkpointer(now);
}

void WorldServer::names_durable(std::size_t count, const Clocks& now) {
  rooms_->order.names().names_durable(count);
  rooms_->people.joining().open_authenticated(now);
  remove_closed();
}

void WorldServer::snapshots_saved(const Clocks& now) {
  rooms_->order.snapshots_saved();
  step_checkpointer(now);
}

void WorldServer::set_disk_is_full(bool is_full, const Clocks& now, const char* why) {
  rooms_->order.set_disk_is_full(is_full, why);
  rooms_->receipts.hurry_durable();  // the watermark tells every session
  rooms_->cluster.send_durable_to_followers();
  rooms_->people.joining().open_authenticated(now);
  remove_closed();
}

void WorldServer::log_failed() {
  rooms_->order.ownership().lose_log();
  rooms_->build_uploads.send_durable();
}

void WorldServer::begin_stop(const Clocks& now) {
  rooms_->commits.commit_all(LargeEdits::all, now);  // the edits that were accepted
  save_state(now);
  rooms_->cluster.begin_stop();
  const TimeUs stop_us = rooms_->cluster.hands_over() ? 0 : rooms_->config.stop_us_max;
  rooms_->order.begin_stop(now.steady_us + stop_us);
  for (Session* session : rooms_->sessions.all())
    rooms_->sessions.close(*session, GoodbyeReason::closing, "the server stops");
  remove_closed();
  rooms_->ground.collect_released();
  rooms_->ground.hurry_loads(now);
  step_checkpointer(now);
}

}  // namespace runstone
