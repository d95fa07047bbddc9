#include "server/world/sessions/sessions.hpp"

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

/// Returns pointers to the sessions of the map for which is_meant() returns true.
template <class Pointer, class Map, class IsMeant>
std::vector<Pointer> pointers(Map& sessions, IsMeant is_meant) {
  std::vector<Pointer> found;
  found.reserve(sessions.size());
  for (auto& [id, session] : sessions) {
    if (is_meant(session)) found.push_back(&session);
  }
  return found;
}

bool is_kept(const Session& session) { return !session.is_closed; }
bool is_open(const Session& session) { return session.is_open(); }

}  // namespace

Session& Sessions::add(SessionId session, TimeUs now_us) {
  const auto [added, is_new] = sessions_.try_emplace(session);
  RUNSTONE_ASSERT(is_new);
  added->second.id = session;
  added->second.connected_us = added->second.last_message_us = now_us;
  return added->second;
}

Session& Sessions::add_relayed(const RelayedSession& relayed, TimeUs now_us) {
  Session& session = add(output_.add(relayed), now_us);
  session.is_relayed = true;
  return session;
}

Session* Sessions::find(SessionId session) {
  const auto found = sessions_.find(session);
  return found == sessions_.end() || found->second.is_closed ? nullptr : &found->second;
}

const Session* Sessions::find(SessionId session) const {
  const auto found = sessions_.find(session);
  return found == sessions_.end() || found->second.is_closed ? nullptr : &found->second;
}

std::vector<Session*> Sessions::all() { return pointers<Session*>(sessions_, is_kept); }
std::vector<const Session*> Sessions::all() const {
  return pointers<const Session*>(sessions_, is_kept);
}
std::vector<Session*> Sessions::open() { return pointers<Session*>(sessions_, runstone::is_open); }
std::vector<const Session*> Sessions::open() const {
  return pointers<const Session*>(sessions_, runstone::is_open);
}

Session* Sessions::of_client(AuthorId author, ClientInstance instance) const {
  const auto found = clients_.find({author, instance});
  return found == clients_.end() || found->second->is_closed ? nullptr : found->second;
}

void Sessions::enter(Session& session, AuthorId author, TimeUs now_us) {
  session.stage = SessionStage::open;
  session.author = author;
  session.position.start(session.pose.at, now_us);
  session.last_message_us = now_us;
  if (!session.is_relayed) clients_[{author, session.instance}] = &session;
  ++counters_.sessions_opened;
  environment_.player_came(visit_of(session));
}

void Sessions::close(Session& session, GoodbyeReason reason, const std::string& text) {
  if (session.is_closed) return;
  ++counters_.sessions_closed;
  output_.close(session.id, reason, text);
  const auto level =
      reason == GoodbyeReason::closing ? OperatorLogLevel::debug : OperatorLogLevel::warn;
  environment_.report(level, "session=" + std::to_string(session.id) +
                                 " closed reason=" + std::to_string(static_cast<unsigned>(reason)) +
                                 " (" + to_string(reason) + ") text=\"" + text + "\"");
  leave(session);
}

void Sessions::leave(Session& session) {
  if (session.is_closed) return;
  const bool was_open = session.is_open();
  mark_closed(session);
  if (was_open) environment_.player_left(visit_of(session));
}

void Sessions::mark_closed(Session& session) {
  session.is_closed = true;
  closed_.push_back(&session);
}

void Sessions::remove_closed() {
  for (Session* session : closed_) {
    const auto client = clients_.find({session->author, session->instance});
    if (client != clients_.end() && client->second == session) clients_.erase(client);
    output_.remove(session->id);
    sessions_.erase(session->id);
  }
  closed_.clear();
}

bool Sessions::send(const Session& session, const EncodedMessage& message) {
  return session.is_closed || output_.send(session.id, message);
}

bool Sessions::send_or_close(Session& session, const EncodedMessage& message) {
  if (send(session, message)) return true;
  ++counters_.queue_full;
  close_slow(session);
  return false;
}

bool Sessions::send_or_skip(const Session& session, const EncodedMessage& message) {
  if (send(session, message)) return true;
  ++counters_.queue_full;
  return false;
}

std::vector<SessionId> Sessions::send_to_all(std::span<const SessionId> sessions,
                                             const EncodedMessage& message) {
  std::vector<SessionId> kept;
  if (!closed_.empty()) {
    std::ranges::copy_if(sessions, std::back_inserter(kept),
                         [this](SessionId session) { return find(session) != nullptr; });
    sessions = kept;
  }
  std::vector<SessionId> full = output_.send_to_all(sessions, message);
  counters_.queue_full += full.size();
  return full;
}

void Sessions::close_slow(Session& session) {
  close(session, GoodbyeReason::timed_out, "send queue full: the peer reads too slowly");
}

void Sessions::charge_reading(const Session& session, std::size_t bytes) {
  if (!session.is_closed) output_.charge_reading(session.id, bytes);
}

PlayerVisit Sessions::visit_of(const Session& session) const {
  const auto players =
      std::ranges::count_if(sessions_, [](const auto& entry) { return entry.second.is_open(); });
  return {session.id, session.author, session.name, session.key, static_cast<std::size_t>(players)};
}

}  // namespace runstone
