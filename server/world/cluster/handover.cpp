#include "server/world/cluster/handover.hpp"

#include <map>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone {

/// Returns the number of the follower with the most players. Requires that one gets the log.
SessionId Handover::follower_with_most_players() const {
  std::optional<SessionId> best;
  std::size_t most = 0;
  for (const KnownServer& server : known_servers()) {
    if (!server.link || !order_.feed().is_served(*server.link)) continue;
    if (best && server.players <= most) continue;
    best = server.link;
    most = server.players;
  }
  RUNSTONE_ASSERT(best);
  return *best;
}

/// Closes the sessions that have not joined yet. They know what this server offers as the owner,
/// and may be other servers that want to follow it.
void Handover::close_joining_sessions() {
  for (Session* session : sessions_.all()) {
    if (session->stage == SessionStage::authenticating && !session->is_relayed)
      sessions_.close(*session, GoodbyeReason::closing, kConnectAgain);
  }
}

std::vector<KnownServer> Handover::known_servers() const {
  std::vector<KnownServer> servers;
  servers.push_back({std::nullopt, config_.player_address, 0, edits_here_});
  std::map<SessionId, std::size_t> players;  // by follower
  for (const Session* session : std::as_const(sessions_).open()) {
    const RelayedSession* there = sessions_.relayed(session->id);
    ++(there == nullptr ? servers[0].players : players[there->link]);
  }
  for (const auto& [link, follower] : followers_.all())
    servers.push_back({link, follower.player_address, players[link], follower.edits});
  return servers;
}

void Handover::count_edit(const Session& session) {
  Follower* const there = followers_.of_session(session.id);
  ++(there == nullptr ? edits_here_ : there->edits);
}

void Handover::begin_owning(const Clocks& now) {
  edits_here_ = 0;
  choice_.begin(now.steady_us);
}

std::optional<std::string> Handover::refusal(std::optional<SessionId> successor) const {
  if (order_.is_following()) return "this server does not own the world";
  if (!order_.log_accepts()) return "the server stops, or its log cannot be written";
  if (!environment_.owns_world())
    return "the database does not answer: another server may own the world";
  if (order_.is_disk_full()) return order_.disk_reason();
  if (!order_.feed().has_served()) return "no other server follows this one";
  if (!successor) return std::nullopt;
  if (followers_.contains(*successor) && order_.feed().is_served(*successor)) return std::nullopt;
  return "no server " + std::to_string(*successor) + " follows this one (servers lists them)";
}

SessionId Handover::hand_over(std::optional<SessionId> successor, const Clocks& now) {
  RUNSTONE_ASSERT(!refusal(successor));
  const SessionId next = successor ? *successor : follower_with_most_players();
  commits_.commit_all(LargeEdits::all, now);
  chat_.broadcast();
  close_joining_sessions();
  followers_.keep_without_log(next);
  order_.ownership().begin_handover();
  following_.begin();
  better_owner_.reset();
  return next;
}

void Handover::choose_owner(const Clocks& now) {
  if (!config_.move_to_builders || !choice_.is_due(now.steady_us)) return;
  OwnerChoice::Counts counts{edits_here_, {}};
  for (const auto& [link, follower] : std::as_const(followers_).all()) {
    if (order_.feed().is_served(link)) counts.there[link] = follower.edits;
  }
  better_owner_ = choice_.look(std::move(counts), now.steady_us);
}

std::optional<SessionId> Handover::take_better_owner() {
  return std::exchange(better_owner_, std::nullopt);
}

}  // namespace runstone
