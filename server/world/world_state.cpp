#include "server/world/world_state.hpp"

#include <set>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

constexpr std::size_t kOwedMax = 4096;  // answers: a session this far behind does not read at all

EditLimits limits_of(const WorldConfig& config) {
  EditLimits limits;
  limits.chunk_edge = config.chunk_edge;
  limits.material_count = config.materials.size();
  limits.heights = config.heights;
  limits.volume_max = config.edit_volume_max;
  return limits;
}

}  // namespace

WorldState::WorldState(WorldConfig config_, const WorldStart& start, WorldEnvironment& ports_,
                       RandomBytes random_)
    : config(std::move(config_)),
      ports(ports_),
      random(std::move(random_)),
      authority(limits_of(config), start.log),
      keeper(config.snapshots, start.checkpoint),
      interest(CoordLimit{kWorldLimit / config.chunk_edge}),
      loads(config.loads_in_flight_max),
      durable(start.log.last),
      view_chunks_left(config.view_chunks_per_tick) {
  for (const auto& [key, version] : start.snapshots) authority.chunks().set_saved(key, version);
  for (const PlayerRow& player : start.players) players.restore(player);
  for (const auto& mark : start.resolved)
    authority.resolved().raise({mark.author, mark.instance, mark.resolved});
}

void forget_session(WorldState& world, SessionId session) {
  const auto found = world.sessions.find(session);
  if (found == world.sessions.end()) return;
  if (found->second.state == SessionStage::open) {
    world.roster_changed = true;
    world.gone_authors.push_back(found->second.author);
  }
  world.sessions.erase(found);
  world.interest.close(session);
  world.loads.take_back(session);
}

void forget_gone_authors(WorldState& world) {
  if (world.gone_authors.empty()) return;
  RUNSTONE_ASSERT(world.authority.queued() ==
                  0);  // or their rows would be missing when they are ordered
  std::set<AuthorId> present;
  for (const auto& [id, session] : world.sessions) {
    if (session.state == SessionStage::open) present.insert(session.author);
  }
  for (const AuthorId author : std::exchange(world.gone_authors, {})) {
    if (present.contains(author) || !world.players.forget_unsaved(author)) continue;
    world.authority.resolved().forget(author);
  }
}

void close_session(WorldState& world, SessionId session, GoodbyeReason reason,
                   const std::string& text) {
  if (world.find(session) == nullptr) return;
  ++world.counters.sessions_closed;
  const auto level = reason == GoodbyeReason::closing ? WorldLogLevel::debug : WorldLogLevel::warn;
  world.ports.log(level, "session=" + std::to_string(session) +
                             " closed reason=" + std::to_string(static_cast<unsigned>(reason)) +
                             " (" + to_string(reason) + ") text=\"" + text + "\"");
  forget_session(world, session);
  world.ports.close(session, reason, text);
}

bool send_or_close(WorldState& world, SessionId session, const Message& message) {
  if (world.ports.send(session, encode_message(message))) return true;
  ++world.counters.queue_full;
  close_session(world, session, GoodbyeReason::timed_out,
                "send queue full: the peer reads too slowly");
  return false;
}

void answer(WorldState& world, SessionId session, Reject reject) {
  WorldSession* mine = world.find(session);
  if (mine == nullptr) return;
  mine->owed.push_back(std::move(reject));
  if (mine->owed.size() == 1) {
    send_owed(world, session);
  } else if (mine->owed.size() > kOwedMax) {
    close_session(world, session, GoodbyeReason::timed_out,
                  "send queue full: the peer reads too slowly");
  }
}

void send_owed(WorldState& world, SessionId session) {
  WorldSession* mine = world.find(session);
  if (mine == nullptr) return;
  std::size_t sent = 0;
  while (sent < mine->owed.size() && send_or_skip(world, session, encode_message(mine->owed[sent])))
    ++sent;
  mine->owed.erase(mine->owed.begin(), mine->owed.begin() + static_cast<std::ptrdiff_t>(sent));
  if (mine->durable_told < world.durable && mine->durable_told < mine->awaits_durable) {
    tell_durable(world, session, encode_message(Durable{world.authority.epoch(), world.durable}));
  }
}

void tell_durable(WorldState& world, SessionId session, const EncodedMessage& encoded) {
  WorldSession* mine = world.find(session);
  if (mine == nullptr || !mine->owed.empty() || mine->durable_told == world.durable) return;
  if (send_or_skip(world, session, encoded)) mine->durable_told = world.durable;
}

bool send_or_skip(WorldState& world, SessionId session, const EncodedMessage& message) {
  if (world.ports.send(session, message)) return true;
  ++world.counters.queue_full;
  return false;
}

}  // namespace runstone
