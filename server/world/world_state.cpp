#include "server/world/world_state.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <set>
#include <utility>

#include "common/core/assert.hpp"
#include "server/world/tile_handlers.hpp"

namespace runstone {
namespace {

// A session with more pending rejects does not read at all.
constexpr std::size_t kPendingRejectsMax = 4096;

EditLimits limits_of(const WorldConfig& config) {
  EditLimits limits;
  limits.chunk_edge = config.chunk_edge;
  limits.material_count = config.materials.size();
  limits.heights = config.heights;
  limits.volume_max = config.edit_volume_max;
  return limits;
}

}  // namespace

WorldState::WorldState(WorldConfig config_, const WorldStart& start, WorldEnvironment& environment_,
                       RandomBytes random_)
    : config(std::move(config_)),
      environment(environment_),
      output(environment_),
      random(std::move(random_)),
      authority(limits_of(config), start.log),
      checkpointer(config.snapshots, start.checkpoint),
      interest(CoordLimit::of(config.chunk_edge)),
      loads(config.loads_in_flight_max),
      edit_ledger(config.edit_budget, config.budgets_per_address),
      load_ledger(config.chunk_loads, config.budgets_per_address),
      claim_ledger({config.names_per_address, config.names_per_address * kClaimPrice}),
      chat(config.chat_budget, config.budgets_per_address),
      durable(start.log.last),
      view_chunks_left(config.view_chunks_per_tick) {
  for (const auto& [key, version] : start.snapshots) authority.chunks().set_saved(key, version);
  for (const PlayerRow& player : start.players) players.restore(player);
  players.begin_above(start.author_max);
  for (const NameClaim& claim : start.name_claims) names.restore(claim);
  for (const ChatEntry& entry : start.chat) {
    chat.add(entry.line);
    if (entry.line.kind == ChatLineKind::player)
      chat.recent.back().author = players.author_of(entry.key).value_or(0);
  }
  for (const RightsRecord& record : start.rights) rights.apply(record.change, record.origin);
  std::array<std::uint8_t, sizeof change_instance> instance{};
  random(instance);
  std::memcpy(&change_instance, instance.data(), sizeof change_instance);
  for (const HighWater& watermark : start.resolved)
    authority.resolved().raise({watermark.author, watermark.instance, watermark.resolved});
}

PlayerVisit visit_of(const WorldState& world, SessionId session, const WorldSession& mine) {
  const auto players =
      std::count_if(world.sessions.begin(), world.sessions.end(),
                    [](const auto& s) { return s.second.state == SessionStage::open; });
  return {session, mine.author, mine.name, mine.key, static_cast<std::size_t>(players)};
}

void forget_session(WorldState& world, SessionId session) {
  const auto found = world.sessions.find(session);
  if (found == world.sessions.end()) return;
  const bool was_open = found->second.state == SessionStage::open;
  if (was_open) {
    world.player_list_changed = true;
    world.gone_authors.push_back(found->second.author);
    const auto client = world.clients.find({found->second.author, found->second.instance});
    if (client != world.clients.end() && client->second == session) world.clients.erase(client);
  }
  forget_tiles(world, session, found->second);
  if (const RelayedSession* there = world.output.relayed(session)) {
    const auto follower = world.followers.find(there->link);
    if (follower != world.followers.end()) follower->second.sessions.erase(there->remote);
    world.output.remove(session);
  }
  if (world.following) session_left(world, session, found->second);
  const auto gone = world.sessions.extract(found);
  if (was_open) world.environment.player_left(visit_of(world, session, gone.mapped()));
  world.interest.close(session);
  world.loads.cancel(session);
}

void forget_gone_authors(WorldState& world) {
  if (world.gone_authors.empty()) return;
  std::set<AuthorId> present;
  for (const auto& [id, session] : world.sessions) {
    if (session.state == SessionStage::open) present.insert(session.author);
  }
  for (const AuthorId author : std::exchange(world.gone_authors, {})) {
    if (present.contains(author)) continue;
    if (world.authority.queue().has_of(author)) {  // the row is needed when the edit is ordered
      world.gone_authors.push_back(author);
      continue;
    }
    if (!world.players.forget_unsaved(author)) continue;
    world.authority.resolved().forget(author);
  }
}

void close_session(WorldState& world, SessionId session, GoodbyeReason reason,
                   const std::string& text) {
  if (world.find(session) == nullptr) return;
  ++world.counters.sessions_closed;
  world.output.close(session, reason, text);
  const auto level =
      reason == GoodbyeReason::closing ? OperatorLogLevel::debug : OperatorLogLevel::warn;
  world.environment.report(level, "session=" + std::to_string(session) + " closed reason=" +
                                      std::to_string(static_cast<unsigned>(reason)) + " (" +
                                      to_string(reason) + ") text=\"" + text + "\"");
  forget_session(world, session);
}

bool send_or_close(WorldState& world, SessionId session, const Message& message) {
  if (world.output.send(session, encode_message(message))) return true;
  ++world.counters.queue_full;
  close_session(world, session, GoodbyeReason::timed_out,
                "send queue full: the peer reads too slowly");
  return false;
}

void send_reject(WorldState& world, SessionId session, Reject reject) {
  WorldSession* mine = world.find(session);
  if (mine == nullptr) return;
  mine->pending_rejects.push_back(std::move(reject));
  if (mine->pending_rejects.size() == 1) {
    send_pending_rejects(world, session);
  } else if (mine->pending_rejects.size() > kPendingRejectsMax) {
    close_session(world, session, GoodbyeReason::timed_out,
                  "send queue full: the peer reads too slowly");
  }
}

void send_pending_rejects(WorldState& world, SessionId session) {
  WorldSession* mine = world.find(session);
  if (mine == nullptr) return;
  std::size_t sent = 0;
  while (sent < mine->pending_rejects.size() &&
         send_or_skip(world, session, encode_message(mine->pending_rejects[sent])))
    ++sent;
  mine->pending_rejects.erase(mine->pending_rejects.begin(),
                              mine->pending_rejects.begin() + static_cast<std::ptrdiff_t>(sent));
  if (mine->durable_sent < world.durable && mine->durable_sent < mine->awaits_durable) {
    send_durable(world, session, encoded_durable(world));
  }
}

EncodedMessage encoded_durable(const WorldState& world) {
  return encode_message(Durable{world.authority.epoch(), world.durable, world.disk_is_full});
}

void send_durable(WorldState& world, SessionId session, const EncodedMessage& encoded) {
  WorldSession* mine = world.find(session);
  if (mine == nullptr || mine->is_relayed || !mine->pending_rejects.empty()) return;
  const bool is_known =
      mine->durable_sent == world.durable && mine->read_only_sent == world.disk_is_full;
  if (is_known || !send_or_skip(world, session, encoded)) return;
  mine->durable_sent = world.durable;
  mine->read_only_sent = world.disk_is_full;
}

bool send_or_skip(WorldState& world, SessionId session, const EncodedMessage& message) {
  if (world.output.send(session, message)) return true;
  ++world.counters.queue_full;
  return false;
}

}  // namespace runstone
