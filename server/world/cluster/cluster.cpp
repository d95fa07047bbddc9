#include "server/world/cluster/cluster.hpp"

#include <utility>

namespace runstone {

Cluster::Cluster(const World& world, const RandomBytes& random)
    : world_(world),
      followers_(world.config, world.environment, world.counters, world.sessions, world.order,
                 world.receipts, world.joining),
      servers_(world.config, world.environment, world.sessions, world.order, followers_),
      link_(world.config, world.environment, world.order, random),
      players_(world.sessions, world.order, link_, world.joining, world.edits, world.presence),
      resumes_(world.sessions),
      following_({world.config, world.environment, world.sessions, world.order, world.receipts,
                  world.commits, world.joining, followers_, servers_, link_, players_, resumes_}),
      handover_(world.config, world.environment, world.sessions, world.order, world.commits,
                world.chat, followers_, following_) {}

void Cluster::follow() {
  world_.order.ownership().begin_following();
  following_.begin();
}

std::vector<LogPart> Cluster::stop_following() {
  world_.order.ownership().begin_takeover();
  return following_.stop();
}

void Cluster::handover_written(const Clocks& now) {
  world_.order.ownership().end_handover();
  followers_.close_kept_at(now.steady_us + kFollowersKeptUs);
}

void Cluster::owner_connected(const std::optional<ChannelBinding>& binding, const Clocks& now) {
  if (is_following()) following_.connected(binding, now);
}

void Cluster::owner_received(Message&& message, const Clocks& now) {
  if (is_following()) following_.received(std::move(message), now);
}

void Cluster::owner_disconnected() {
  if (is_following()) following_.disconnected();
}

void Cluster::missed_log_read(const Result<ReadLog, std::string>& read, const Clocks& now) {
  // The answer may come when this server has become the owner. It ends the read in any case.
  following_.missed_log_read(read, now);
}

void Cluster::checkpoint_moved(Sequence checkpoint) {
  if (is_following()) world_.order.chunks().saved_up_to(checkpoint);
}

bool Cluster::take_over(const Takeover& start, const Clocks& now) {
  if (!following_.catch_up(start.read, now)) {
    world_.order.ownership().find_fork();
    return false;
  }
  followers_.close_all("this server owns the world again");  // they get its log from the start
  world_.order.ownership().end_takeover();
  handover_.begin_owning(now);
  world_.order.authority().log_clock().take_over(now);
  world_.order.begin_owning(start.checkpoint, start.author_max);
  servers_.hold(now);
  world_.commits.begin_epoch(start.epoch);
  world_.presence.begin_anew();
  world_.places.restore(start.places);
  world_.visits.begin_anew();
  for (Session* session : world_.sessions.open()) {
    if (!world_.order.players().adopt({session->author, session->key, session->name})) {
      world_.sessions.close(*session, GoodbyeReason::closing, kConnectAgain);
    } else {
      resumes_.send(*session, world_.order.resolved(session->author, session->instance));
    }
  }
  for (auto& [session, brought] : players_.take_joining()) {
    if (!session->is_closed) world_.joining.let_in(*session, brought, now);
  }
  return true;
}

void Cluster::forget(const Session& session) {
  followers_.forget_session(session);
  following_.forget(session);
  resumes_.forget(session.id);
  servers_.forget(session.id);
}

void Cluster::check_connections(const Clocks& now) {
  followers_.close_lost(now);
  if (is_following()) following_.tick(now);
}

void Cluster::tick_owner(const Clocks& now) {
  servers_.update(now);
  handover_.choose_owner(now);
}

void Cluster::begin_stop() {
  // Another server takes over as soon as this one lets go, and reads the edits from the log.
  hands_over_ = world_.order.feed().has_served();
  followers_.close_all("the server stops");
}

}  // namespace runstone
