#include "server/world/world_server.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "common/core/assert.hpp"
#include "common/core/key_text.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "protocol/codec/invite_token.hpp"
#include "protocol/codec/server_link.hpp"
#include "server/world/broadcast.hpp"
#include "server/world/cached_chunk_handlers.hpp"
#include "server/world/chat_handlers.hpp"
#include "server/world/command_handlers.hpp"
#include "server/world/delivery.hpp"
#include "server/world/digest_check_scheduler.hpp"
#include "server/world/followers.hpp"
#include "server/world/following.hpp"
#include "server/world/handover.hpp"
#include "server/world/handshake_handlers.hpp"
#include "server/world/listed_servers.hpp"
#include "server/world/log_mark_handlers.hpp"
#include "server/world/material_handlers.hpp"
#include "server/world/name_rules.hpp"
#include "server/world/past_tiles.hpp"
#include "server/world/presence.hpp"
#include "server/world/preview_handlers.hpp"
#include "server/world/protected_ground.hpp"
#include "server/world/request_handlers.hpp"
#include "server/world/rights_handlers.hpp"
#include "server/world/server_edits.hpp"
#include "server/world/tile_handlers.hpp"
#include "server/world/time_travel.hpp"
#include "server/world/view_scheduler.hpp"
#include "server/world/world_state.hpp"

namespace runstone {
namespace {

void on_open_message(WorldState& world, SessionId session, const Message& message,
                     const Clocks& now) {
  if (const auto* view = std::get_if<View>(&message)) return on_view(world, session, *view, now);
  if (const auto* held = std::get_if<CachedChunks>(&message))
    return on_cached_chunks(world, session, *held);
  if (const auto* request = std::get_if<ChunkRequest>(&message)) {
    return on_chunk_request(world, session, *request, now);
  }
  if (const auto* edit = std::get_if<EditRequest>(&message))
    return on_edit(world, session, *edit, now);
  if (const auto* move = std::get_if<Move>(&message)) return on_move(world, session, *move, now);
  if (const auto* ping = std::get_if<Ping>(&message)) return on_ping(world, session, *ping, now);
  if (const auto* request = std::get_if<HistoryRequest>(&message))
    return on_history_request(world, session, *request, now);
  if (const auto* request = std::get_if<LogMarksRequest>(&message))
    return on_log_marks_request(world, session, *request, now);
  if (const auto* command = std::get_if<CommandRequest>(&message)) {
    return on_command(world, session, *command, now);
  }
  if (const auto* chat = std::get_if<ChatRequest>(&message))
    return on_chat(world, session, *chat, now);
  if (const auto* share = std::get_if<PreviewShare>(&message))
    return on_preview_share(world, session, *share, now);
}

void on_resumed(WorldState& world, SessionId session) {
  WorldSession& mine = *world.find(session);
  if (mine.resumes_unanswered == 0)
    return close_session(world, session, GoodbyeReason::unexpected_message,
                         "resumed, but there was no resume");
  --mine.resumes_unanswered;
}

/// Loads a chunk again after a pause. Returns false after too many failures in a row.
bool load_again(WorldState& world, const ChunkKey& key, OperatorLogLevel level,
                const std::string& why, const Clocks& now) {
  auto pause_us = world.load_retries.failed(key, now.steady_us);
  // The database of several servers may be away for long.
  if (!pause_us && world.following) pause_us = world.load_retries.failed(key, now.steady_us);
  if (!pause_us) return false;
  world.environment.report(level, "chunk=" + text_of(key) + " not read, again in " +
                                      std::to_string(*pause_us / 1'000'000) + " s: " + why);
  return true;
}

void close_silent_sessions(WorldState& world, const Clocks& now) {
  std::vector<std::pair<SessionId, bool>> silent;
  for (const auto& [id, session] : world.sessions) {
    if (session.is_relayed) continue;  // the server that it is connected to closes it
    const bool is_open = session.state == SessionStage::open;
    const TimeUs since = is_open ? session.last_message_us : session.connected_us;
    const TimeUs limit = is_open ? world.config.idle_us_max : world.config.handshake_us_max;
    if (now.steady_us - since >= limit) silent.emplace_back(id, is_open);
  }
  for (const auto& [id, was_open] : silent) {
    close_session(world, id, GoodbyeReason::timed_out,
                  was_open ? "no message for too long" : "the handshake took too long");
  }
}

void retry_pending(WorldState& world, const Clocks& now) {
  for (const SessionId id : world.open_sessions()) {
    send_pending_rejects(world, id);
    if (world.find(id) != nullptr && world.interest.nearest_wanted(id)) {
      world.deliveries.insert(id);
    } else {
      deliver(world, id, now);
    }
    if (world.find(id) == nullptr) continue;
    send_not_modified(world, id, false);  // they wait for more of them until the next tick
    send_uniform(world, id, now);
  }
}

/// Loads chunks again whose pause has ended. Their residency stayed `loading`.
void retry_loads(WorldState& world, const Clocks& now) {
  for (const ChunkKey& key : world.load_retries.take_due(now.steady_us)) {
    world.loads.load_started();
    world.environment.load_chunk(key);
  }
}

/// Counts the end of a load that was under way.
void count_load_end(WorldState& world, const ChunkKey& key) {
  if (world.authority.chunks().residency(key) == Residency::loading) world.loads.load_ended();
}

}  // namespace

WorldServer::WorldServer(WorldConfig config, const WorldStart& start, WorldEnvironment& environment,
                         RandomBytes random)
    : state_(
          std::make_unique<WorldState>(std::move(config), start, environment, std::move(random))) {}
WorldServer::~WorldServer() = default;

void WorldServer::replay_onto_stack(const EditRecord& record) {
  state_->authority.replay_onto_stack(record);
  if (state_->config.tile_levels_max > 0 && has_voxels(record.edit)) {
    std::vector<ChunkKey> keys;
    for (const ChunkCoord at : touched_chunks(record.edit, state_->config.chunk_edge))
      keys.push_back({0, at});
    state_->environment.tiles_edited(keys, record.version.seq);
  }
}

void WorldServer::reconfigure(const WorldConfig& config) {
  WorldConfig& mine = state_->config;
  mine.sessions_per_key = config.sessions_per_key;
  mine.sessions_per_address = config.sessions_per_address;
  mine.idle_us_max = config.idle_us_max;
  mine.reach_max = config.reach_max;
  mine.speed_max = config.speed_max;
  mine.operators = config.operators;
  mine.link_address = config.link_address;
  mine.message_of_the_day = config.message_of_the_day;
  mine.move_to_builders = config.move_to_builders;
  rights_changed(*state_, {});
}

void WorldServer::connected(SessionId session, const Clocks& now, AddressBlock from,
                            const std::optional<ChannelBinding>& binding) {
  WorldSession fresh;
  fresh.address = from;
  fresh.binding = binding;
  fresh.connected_us = fresh.last_message_us = now.steady_us;
  const bool is_new = state_->sessions.emplace(session, std::move(fresh)).second;
  RUNSTONE_ASSERT(is_new);
  if (state_->is_stopping)
    close_session(*state_, session, GoodbyeReason::closing, "the server stops");
}

void WorldServer::received(SessionId session, Message&& message, const Clocks& now) {
  WorldState& world = *state_;
  if (world.followers.contains(session)) return on_follower_message(world, session, message, now);
  WorldSession* mine = world.find(session);
  if (mine == nullptr) return;
  ++world.counters.messages;
  mine->last_message_us = now.steady_us;
  if (std::holds_alternative<Goodbye>(message)) {
    close_session(world, session, GoodbyeReason::closing, "the client said goodbye");
    return;
  }
  const auto refusal = refusal_of(info_of(message), Sender::client, mine->state, mine->features);
  if (refusal) return close_session(world, session, refusal->reason, refusal->text);
  if (const auto* hello = std::get_if<Hello>(&message)) return on_hello(world, session, *hello);
  if (const auto* auth = std::get_if<ClientAuth>(&message))
    return on_client_auth(world, session, *auth, now);
  if (const auto* request = std::get_if<KeyRequest>(&message))
    return on_key_request(world, session, *request, now);
  if (const auto* deposit = std::get_if<KeyDeposit>(&message))
    return on_key_deposit(world, session, *deposit, now);
  if (std::holds_alternative<Resumed>(message)) return on_resumed(world, session);
  // It was sent before the client knew that another server orders now, and will be offered again.
  const bool is_lost = mine->needs_resume || mine->resumes_unanswered > 0;
  if (is_lost && std::holds_alternative<EditRequest>(message)) return;
  if (world.following && on_message_for_owner(world, session, message, now)) return;
  on_open_message(world, session, message, now);
}

void WorldServer::disconnected(SessionId session) {
  forget_follower(*state_, session);
  forget_session(*state_, session);
  collect_released(*state_);
}

void WorldServer::drained(SessionId session, const Clocks& now) {
  WorldSession* mine = state_->find(session);
  if (mine == nullptr) return;
  mine->stalled_us.reset();
  send_pending_rejects(*state_, session);
  deliver(*state_, session, now);
}

bool WorldServer::has_ready_edits(TimeUs now_us) const {
  return runstone::has_ready_edits(*state_, now_us);
}

bool WorldServer::has_deliveries() const { return !state_->deliveries.empty(); }
void WorldServer::deliver_next(const Clocks& now) { runstone::deliver_next(*state_, now); }

void WorldServer::commit_one(const Clocks& now) {
  commit_and_broadcast(*state_, LargeEdits::paced, now);
}
void WorldServer::commit(const Clocks& now) {
  while (commit_and_broadcast(*state_, LargeEdits::paced, now)) {
  }
}

ServerEditsResult WorldServer::order_server_edits(const std::vector<EditOffer>& offers,
                                                  AuthorId payer, const Clocks& now) {
  return runstone::order_server_edits(*state_, offers, payer, now);
}

void WorldServer::answer_command(SessionId session, const std::vector<std::string>& lines,
                                 bool is_done, bool is_ok) {
  send_command_output(*state_, session, lines, is_done, is_ok);
}

std::vector<WorldServer::OnlinePlayer> WorldServer::online_players() const {
  std::vector<OnlinePlayer> out;
  for (const auto& [id, session] : state_->sessions) {
    if (session.state != SessionStage::open) continue;
    out.push_back({id, session.author, session.name, session.key, session.pose.at});
  }
  return out;
}

std::vector<PlayerRow> WorldServer::visitors() const {
  const auto& visitors = state_->players.visitors();
  return {visitors.begin(), visitors.end()};
}

std::vector<NameClaim> WorldServer::name_claims() const { return state_->names.all(); }
std::optional<AuthorId> WorldServer::author_of(const PublicKey& key) const {
  return state_->players.author_of(key);
}
Result<NameClaim, std::string> WorldServer::release_name(const std::string& name) {
  return runstone::release_name(*state_, name);
}

const RightsState& WorldServer::rights() const { return state_->rights; }
TimeUs WorldServer::rights_time() const { return runstone::rights_time(*state_); }

Sequence WorldServer::newest_rights() const { return state_->rights_seq; }
std::optional<std::string> WorldServer::change_refusal(const RightsChange& change,
                                                       const RightsActor& actor) const {
  return runstone::change_refusal(*state_, actor, change);
}

Result<Sequence, std::string> WorldServer::change_rights(const RightsChange& change,
                                                         const RightsActor& actor, AuthorId author,
                                                         const Clocks& now) {
  return runstone::change_rights(*state_, change, actor, author, now);
}

const MaterialTable& WorldServer::materials() const { return state_->config.materials; }

Result<AddedAt, MaterialsRefusal> WorldServer::add_materials(const std::vector<MaterialRow>& rows,
                                                             const Clocks& now) {
  return runstone::add_materials(*state_, rows, now);
}

std::vector<RefusalRow> WorldServer::refusals() const { return state_->refusals.rows(); }

std::size_t WorldServer::say(const std::string& text, const PublicKey& by, const Clocks& now) {
  return runstone::say(*state_, text, by, now);
}

InviteId WorldServer::new_invite_id() {
  std::array<std::uint8_t, sizeof(InviteId)> bytes{};
  state_->random(bytes);
  return ByteReader(bytes).u64();
}

std::string WorldServer::invite_link(InviteId invite) const {
  const WorldConfig& config = state_->config;
  const std::string token = invite_token(invite, config.world_id, config.server_keys);
  return text_of(ServerLink{config.link_address, token});
}

std::size_t WorldServer::kick(const RestrictionSubject& who, const std::string& reason) {
  return runstone::kick(*state_, who, reason);
}

std::optional<std::string> WorldServer::edit_refusal(AuthorId author,
                                                     const EditDescriptor& edit) const {
  if (author == 0) return std::nullopt;
  const auto key = state_->players.key_of(author);
  return key ? runstone::edit_refusal(*state_, *key, edit) : "the player has left";
}

void WorldServer::step_checkpointer(const Clocks& now) {
  WorldState& world = *state_;
  if (world.following) return;  // the owner of the world writes snapshots
  if (world.is_stopping && now.steady_us >= world.stop_due_us) {
    world.checkpointer.abandon();
    world.loads.cancel_for_world();
  }
  world.checkpointer.step(world.authority, world.durable, now, world.environment,
                          [&](const ChunkKey& key) { request_load(world, key, now); });
}

void WorldServer::tick(const Clocks& now) {
  WorldState& world = *state_;
  commit_one(now);
  if (const auto warning = world.authority.log_clock().take_warning())
    world.environment.report(OperatorLogLevel::warn, *warning);
  forget_gone_authors(world);
  close_silent_sessions(world, now);
  close_lost_followers(world, now);
  close_kept_followers(world, now);
  if (world.following) tick_following(world, now);
  apply_due_views(world, now);
  send_due_ground(world);
  if (!world.following) {  // the owner of the world sends them
    broadcast_player_list(world);
    broadcast_chat(world);
    broadcast_poses(world, now);
    update_listed_servers(world, now);
    choose_owner(world, now);
  }
  send_listed_servers(world);
  broadcast_durable(world, now);
  send_due_digest_checks(world, now);
  open_waiting_history(world, now);
  read_waiting_log_marks(world, now);
  retry_loads(world, now);
  retry_pending(world, now);
  step_checkpointer(now);
  collect_released(world);
  keep_memory_bounds(world);
  start_loads(world, now);  // of the chunks that waited for memory
  start_tiles(world, now);
  runstone::resend_tiles(world, now);
}

bool WorldServer::has_tile_resends() const { return !state_->tiles.resends.empty(); }

void WorldServer::resend_tiles(const Clocks& now) { runstone::resend_tiles(*state_, now); }

void WorldServer::chunk_loaded(const ChunkKey& key, Chunk chunk, const Clocks& now) {
  WorldState& world = *state_;
  count_load_end(world, key);
  const bool is_newer = chunk.version > world.authority.chunks().version(key);
  if (is_newer && (world.following || !world.environment.owns_world())) {
    // The owner has saved it, and what made this version is still on its way. That may take as long as
    // the owner does not answer, so these attempts do not count. A server that has lost the lease may read
    // what the next owner has saved.
    world.load_retries.ended(key);
    load_again(world, key, OperatorLogLevel::debug, "it is newer than what has arrived", now);
    return start_loads(world, now);
  }
  world.load_retries.ended(key);
  if (const auto wrong = world.authority.chunks().loaded(key, std::move(chunk))) {
    ++world.counters.chunks_failed;
    world.environment.report(OperatorLogLevel::error,
                             "chunk=" + text_of(key) + " quarantined: " + *wrong);
  }
  deliver_loaded(world, key, now);
  // A chunk that was loaded for its stack alone has no user, so nothing else makes it a candidate
  // for eviction.
  if (!world.interest.is_used(key)) world.authority.chunks().released(key);
  step_checkpointer(now);
  start_loads(world, now);
}

void WorldServer::chunk_failed(const ChunkKey& key, LoadFailure failure, const std::string& what,
                               const Clocks& now) {
  WorldState& world = *state_;
  count_load_end(world, key);
  if (failure == LoadFailure::not_read && !world.is_stopping &&
      load_again(world, key, OperatorLogLevel::error, what, now))
    return start_loads(world, now);
  world.load_retries.ended(key);
  ++world.counters.chunks_failed;
  world.authority.chunks().quarantine(key);
  world.environment.report(OperatorLogLevel::error,
                           "chunk=" + text_of(key) + " quarantined: " + what);
  deliver_loaded(world, key, now);
  step_checkpointer(now);
  start_loads(world, now);
}

void WorldServer::tiles_made(const ChunkKey& key, const std::vector<MadeTile>& made,
                             const Clocks& now) {
  on_tiles_made(*state_, key, made, now);
}

void WorldServer::tile_stopped(const ChunkKey& key, const std::vector<MadeTile>& made,
                               const Clocks& now) {
  on_tile_stopped(*state_, key, made, now);
}

void WorldServer::past_tile_made(SessionId session, const TileRequest& request,
                                 const std::vector<MadeTile>& made, const Clocks& now) {
  on_past_tile_made(*state_, session, request, made, now);
}

void WorldServer::past_tile_stopped(SessionId session, const TileRequest& request,
                                    const std::vector<MadeTile>& made, const Clocks& now) {
  on_past_tile_stopped(*state_, session, request, made, now);
}

void WorldServer::history_opened(SessionId session, std::uint32_t request,
                                 const Result<OpenedHistory, std::string>& opened,
                                 const Clocks& now) {
  on_history_opened(*state_, session, request, opened, now);
}

void WorldServer::history_chunk_loaded(SessionId session, HistoryNumber history,
                                       const ChunkKey& key,
                                       const Result<ChunkPtr, std::string>& chunk,
                                       const Clocks& now) {
  if (!chunk)
    state_->environment.report(OperatorLogLevel::error,
                               "chunk=" + text_of(key) + " of the past: " + chunk.error());
  on_history_chunk(*state_, session, history, key, chunk ? *chunk : nullptr, now);
}

void WorldServer::follow() {
  RUNSTONE_ASSERT(state_->sessions.empty());
  begin_following(*state_);
}

bool WorldServer::is_following() const { return state_->following != nullptr; }
bool WorldServer::owns_world() const { return !is_following() && state_->environment.owns_world(); }
bool WorldServer::is_live() const {
  return !state_->following || state_->following->link == Following::Link::live;
}
bool WorldServer::has_forked() const { return state_->following && state_->following->has_forked; }
Version WorldServer::last_record() const {
  return {state_->authority.last_epoch(), state_->authority.head()};
}
std::optional<TimeUs> WorldServer::owner_heard_us() const {
  const Following* mine = state_->following.get();
  const bool is_connected = mine != nullptr && (mine->link == Following::Link::reading ||
                                                mine->link == Following::Link::live);
  return is_connected ? std::optional(mine->heard_us) : std::nullopt;
}
std::size_t WorldServer::follower_count() const { return state_->followers.size(); }
std::vector<KnownServer> WorldServer::known_servers() const {
  return runstone::known_servers(*state_);
}

void WorldServer::owner_connected(const std::optional<ChannelBinding>& binding, const Clocks& now) {
  if (state_->following) runstone::owner_connected(*state_, binding, now);
}

void WorldServer::owner_received(Message&& message, const Clocks& now) {
  if (state_->following) on_owner_message(*state_, std::move(message), now);
}

void WorldServer::owner_disconnected() {
  if (state_->following) runstone::owner_disconnected(*state_);
}

void WorldServer::log_read(const Result<ReadLog, std::string>& read, const Clocks& now) {
  if (state_->following) on_log_read(*state_, read, now);
}

void WorldServer::checkpoint_moved(Sequence checkpoint) {
  if (state_->following) state_->authority.chunks().saved_up_to(checkpoint);
}

std::vector<LogPart> WorldServer::stop_following() {
  WorldState& world = *state_;
  runstone::owner_disconnected(world);
  world.following->is_taking_over = true;
  std::vector<LogPart> parts;
  for (const KeptPart& kept : world.following->not_durable) parts.push_back(kept.part);
  return parts;
}

bool WorldServer::take_over(const Takeover& start, const Clocks& now) {
  WorldState& world = *state_;
  if (take_read(world, start.read, now) || world.authority.head() != start.read.last) {
    world.following->has_forked = true;
    return false;
  }
  close_followers(world, "this server owns the world again");  // they get its log from the start
  world.config.features |= world.following->owner_features;
  world.following.reset();
  world.edits_here = 0;
  world.owner_choice.begin(now.steady_us);
  world.durable = world.authority.head();
  world.disk_is_full = false;  // of the owner before; the log of this server says if it is
  world.checkpointer = Checkpointer(world.config.snapshots, start.checkpoint);
  world.players.begin_above(start.author_max);
  hold_listed_servers(world, now);
  begin_epoch(world, start.epoch);
  world.player_list_changed = true;
  world.sent_player_list.clear();
  for (const SessionId session : world.open_sessions()) {
    WorldSession& mine = *world.find(session);
    if (!world.players.adopt({mine.author, mine.key, mine.name})) {
      close_session(world, session, GoodbyeReason::closing, kConnectAgain);
      continue;
    }
    mine.has_player_list = false;
    mine.pose_changed = true;
    send_resume(world, session, world.authority.resolved().of(mine.author, mine.instance));
  }
  let_waiting_in(world, now);
  return true;
}

std::optional<std::string> WorldServer::handover_refusal(std::optional<SessionId> successor) const {
  return runstone::handover_refusal(*state_, successor);
}

SessionId WorldServer::hand_over(std::optional<SessionId> successor, const Clocks& now) {
  const SessionId next = runstone::hand_over(*state_, successor, now);
  collect_released(*state_);
  return next;
}

void WorldServer::handover_written(const Clocks& now) {
  state_->following->followers_end_us = now.steady_us + kFollowersKeptUs;
}

std::optional<SessionId> WorldServer::take_better_owner() {
  return std::exchange(state_->better_owner, std::nullopt);
}

std::optional<View> WorldServer::restore_preview_view(SessionId session) const {
  return runstone::restore_preview_view(*state_, session);
}

void WorldServer::show_restore(SessionId session, const RestorePreview& preview) {
  send_restore_preview(*state_, session, preview);
}

void WorldServer::log_marks_read(SessionId session, std::uint32_t request,
                                 const Result<FoundLogMarks, std::string>& found,
                                 const Clocks& now) {
  on_log_marks_read(*state_, session, request, found, now);
}

void WorldServer::durable(Sequence seq, const Clocks& now) {
  WorldState& world = *state_;
  RUNSTONE_ASSERT(seq <= world.authority.head());
  if (seq <= world.durable) return;
  world.durable = seq;
  world.unwritten.durable(seq);
  send_durable_to_authors(world);
  send_durable_to_followers(world);
  step_checkpointer(now);
}

void WorldServer::names_durable(std::size_t count, const Clocks& now) {
  state_->names.names_durable(count);
  open_authenticated(*state_, now);
}

void WorldServer::snapshots_saved(const Clocks& now) {
  state_->checkpointer.saved(state_->authority.chunks());
  step_checkpointer(now);
}

void WorldServer::set_disk_is_full(bool is_full, const Clocks& now) {
  state_->disk_is_full = is_full;
  state_->durable_due_us = 0;  // the watermark tells every session
  send_durable_to_followers(*state_);
  open_authenticated(*state_, now);
}

void WorldServer::log_failed() { state_->accepts_edits = false; }

void WorldServer::begin_stop(const Clocks& now) {
  WorldState& world = *state_;
  while (commit_and_broadcast(world, LargeEdits::all, now)) {  // the edits that were accepted
  }
  world.accepts_edits = false;
  world.is_stopping = true;
  // Another server takes over as soon as this one lets go, and reads the edits from the log.
  world.hands_over = has_live_followers(world);
  world.stop_due_us = now.steady_us + (world.hands_over ? 0 : world.config.stop_us_max);
  world.checkpointer.finish();
  close_followers(world, "the server stops");
  while (!world.sessions.empty()) {
    close_session(world, world.sessions.begin()->first, GoodbyeReason::closing, "the server stops");
  }
  collect_released(world);
  world.load_retries.hurry();
  retry_loads(world, now);
  step_checkpointer(now);
}

bool WorldServer::is_flushed() const {
  if (state_->following) return true;
  return state_->authority.queue().size() == 0 && state_->durable == state_->authority.head() &&
         (state_->checkpointer.is_clean(state_->authority) || is_stop_overdue());
}

bool WorldServer::hands_over() const { return state_->hands_over; }
bool WorldServer::is_stop_overdue() const { return state_->checkpointer.is_abandoned(); }
std::size_t WorldServer::dirty_chunks() const { return state_->authority.chunks().dirty().size(); }

bool WorldServer::accepts_edits() const { return runstone::accepts_edits(*state_); }
bool WorldServer::has_waiting_edit(AuthorId author) const {
  return state_->authority.queue().has_of(author);
}
Epoch WorldServer::epoch() const { return state_->authority.epoch(); }
Sequence WorldServer::head() const { return state_->authority.head(); }
ClientSequence WorldServer::resolved(AuthorId author, ClientInstance instance) const {
  return state_->authority.resolved().of(author, instance);
}
Sequence WorldServer::durable() const { return state_->durable; }
Sequence WorldServer::checkpoint() const { return state_->checkpointer.checkpoint(); }
std::size_t WorldServer::session_count() const { return state_->sessions.size(); }
std::size_t WorldServer::resident_chunks() const {
  return state_->authority.chunks().resident_count();
}
WorldMemory WorldServer::memory() const { return world_memory_of(*state_); }
const StackDepths& WorldServer::stack_depths() const {
  return state_->authority.chunks().stack_depths();
}
const WorldCounters& WorldServer::counters() const { return state_->counters; }
const WaitHistogram& WorldServer::edit_waits() const { return state_->authority.edit_waits(); }
ChunkPtr WorldServer::find_chunk(const ChunkKey& key) const {
  return state_->authority.chunks().find(key);
}
std::vector<std::pair<ChunkKey, ChunkPtr>> WorldServer::edited_chunks() const {
  return state_->authority.chunks().edited();
}
Version WorldServer::chunk_version(const ChunkKey& key) const {
  return state_->authority.chunks().version(key);
}

}  // namespace runstone
