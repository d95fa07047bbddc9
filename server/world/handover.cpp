#include "server/world/handover.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"
#include "server/world/broadcast.hpp"
#include "server/world/chat_handlers.hpp"
#include "server/world/followers.hpp"
#include "server/world/following.hpp"
#include "server/world/world_state.hpp"

namespace runstone {
namespace {

/// Returns the number of the follower with the most players. Requires that one gets the log.
SessionId follower_with_most_players(const WorldState& world) {
  std::optional<SessionId> best;
  std::size_t most = 0;
  for (const KnownServer& server : known_servers(world)) {
    if (!server.link || !is_served(world.followers.at(*server.link))) continue;
    if (best && server.players <= most) continue;
    best = server.link;
    most = server.players;
  }
  RUNSTONE_ASSERT(best);
  return *best;
}

/// Closes the sessions that have not joined yet. They know what this server offers as the owner, and
/// may be other servers that want to follow it.
void close_joining_sessions(WorldState& world) {
  std::vector<SessionId> joining;
  for (const auto& [id, session] : world.sessions) {
    if (session.state == SessionStage::authenticating && !session.is_relayed) joining.push_back(id);
  }
  for (const SessionId session : joining)
    close_session(world, session, GoodbyeReason::closing, kConnectAgain);
}

/// Closes the followers that have not asked for the log yet.
void close_new_followers(WorldState& world) {
  std::vector<SessionId> fresh;
  for (const auto& [link, follower] : world.followers) {
    if (!follower.gets_log) fresh.push_back(link);
  }
  for (const SessionId link : fresh) {
    world.environment.close(link, GoodbyeReason::closing, kConnectAgain);
    forget_follower(world, link);
  }
}

}  // namespace

std::vector<KnownServer> known_servers(const WorldState& world) {
  std::vector<KnownServer> servers;
  servers.push_back({std::nullopt, world.config.player_address, 0, world.edits_here});
  std::map<SessionId, std::size_t> players;  // by follower
  for (const auto& [id, session] : world.sessions) {
    if (session.state != SessionStage::open) continue;
    const RelayedSession* there = world.output.relayed(id);
    ++(there == nullptr ? servers[0].players : players[there->link]);
  }
  for (const auto& [link, follower] : world.followers)
    servers.push_back({link, follower.player_address, players[link], follower.edits});
  return servers;
}

void count_edit(WorldState& world, SessionId session) {
  const RelayedSession* there = world.output.relayed(session);
  ++(there == nullptr ? world.edits_here : world.followers.at(there->link).edits);
}

std::optional<std::string> handover_refusal(const WorldState& world,
                                            std::optional<SessionId> successor) {
  if (world.following) return "this server does not own the world";
  if (!world.accepts_edits) return "the server stops, or its log cannot be written";
  if (!world.environment.owns_world())
    return "the database does not answer: another server may own the world";
  if (world.disk_is_full) return kDiskIsFull;
  if (!has_live_followers(world)) return "no other server follows this one";
  if (!successor) return std::nullopt;
  const auto found = world.followers.find(*successor);
  if (found != world.followers.end() && is_served(found->second)) return std::nullopt;
  return "no server " + std::to_string(*successor) + " follows this one (servers lists them)";
}

SessionId hand_over(WorldState& world, std::optional<SessionId> successor, const Clocks& now) {
  RUNSTONE_ASSERT(!handover_refusal(world, successor));
  const SessionId next = successor ? *successor : follower_with_most_players(world);
  while (commit_and_broadcast(world, LargeEdits::all, now)) {
  }
  broadcast_chat(world);
  close_joining_sessions(world);
  close_new_followers(world);
  for (auto& [link, follower] : world.followers) {
    follower.gets_log = false;
    for (const auto& [remote, session] : std::exchange(follower.sessions, {}))
      forget_session(world, session);
  }
  world.environment.close(next, GoodbyeReason::closing, "it hands the world over to this server");
  forget_follower(world, next);
  begin_following(world);
  owner_disconnected(world);  // the open sessions go on when there is an owner
  world.better_owner.reset();
  return next;
}

void close_kept_followers(WorldState& world, const Clocks& now) {
  if (world.following && now.steady_us >= world.following->followers_end_us)
    close_followers(world, "this server does not own the world any more");
}

void choose_owner(WorldState& world, const Clocks& now) {
  if (!world.config.move_to_builders || !world.owner_choice.is_due(now.steady_us)) return;
  OwnerChoice::Counts counts{world.edits_here, {}};
  for (const auto& [link, follower] : world.followers) {
    if (is_served(follower)) counts.there[link] = follower.edits;
  }
  world.better_owner = world.owner_choice.look(std::move(counts), now.steady_us);
}

}  // namespace runstone
