#include "server/world/cluster/followers.hpp"

#include <algorithm>
#include <utility>
#include <variant>
#include <vector>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

// More would fill the queue of the connection.
constexpr std::size_t kUnwrittenSentMax = 8'192;

/// Returns true if a player may send this message through another server.
bool may_be_relayed(const Message& message) {
  return std::holds_alternative<EditRequest>(message) || std::holds_alternative<Move>(message) ||
         std::holds_alternative<CommandRequest>(message) ||
         std::holds_alternative<ChatRequest>(message);
}

}  // namespace

Follower* Followers::of_session(SessionId session) {
  const RelayedSession* there = sessions_.relayed(session);
  return there == nullptr ? nullptr : &all_.at(there->link);
}

const Follower* Followers::of_session(SessionId session) const {
  const RelayedSession* there = sessions_.relayed(session);
  return there == nullptr ? nullptr : &all_.at(there->link);
}

void Followers::close(SessionId link, GoodbyeReason reason, const std::string& text) {
  environment_.report(OperatorLogLevel::warn,
                      "follower=" + std::to_string(link) + " closed text=\"" + text + "\"");
  environment_.close(link, reason, text);
  forget(link);
}

void Followers::on_relay_open(SessionId link, const RelayOpen& open, const Clocks& now) {
  if (all_.at(link).sessions.contains(open.session))
    return close(link, GoodbyeReason::unexpected_message, "a session twice");
  Session& session = sessions_.add_relayed({link, open.session}, now.steady_us);
  all_.at(link).sessions[open.session] = session.id;
  joining_.join_relayed(session, open, now);
}

std::optional<RelayedMessage> Followers::on_relay(SessionId link, const Relay& relay,
                                                  const Clocks& now) {
  const auto& there = all_.at(link).sessions;
  const auto found = there.find(relay.sessions.front());
  if (found == there.end())
    return std::nullopt;  // it was closed here while the message was under way
  Session* const session = sessions_.find(found->second);
  if (session == nullptr) return std::nullopt;
  session->last_message_us = now.steady_us;
  if (!may_send(info_of(relay.message.kind), Sender::client)) {
    close(link, GoodbyeReason::unexpected_message, "not of a player");
    return std::nullopt;
  }
  auto message =
      decode_message(Sender::client, relay.message.kind, *relay.message.bytes, config_.chunk_edge);
  // The follower has verified it, so the follower is to blame.
  if (!message || !may_be_relayed(*message)) {
    close(link, GoodbyeReason::malformed_message, "a bad relayed message");
    return std::nullopt;
  }
  ++counters_.messages;
  if (const auto refusal =
          refusal_of(info_of(*message), Sender::client, session->stage, session->features)) {
    sessions_.close(*session, refusal->reason, refusal->text);
    return std::nullopt;
  }
  return RelayedMessage{*session, *std::move(message)};
}

void Followers::on_relay_close(SessionId link, const RelayClose& close) {
  const auto& there = all_.at(link).sessions;
  const auto found = there.find(close.session);
  if (found == there.end()) return;
  if (Session* const session = sessions_.find(found->second)) sessions_.leave(*session);
}

void Followers::on_follow_request(SessionId link, const FollowRequest& request, const Clocks& now) {
  if (!environment_.owns_world())
    return close(link, GoodbyeReason::closing, "another server may own the world");
  Follower& follower = all_.at(link);
  LogFeed& feed = order_.feed();
  feed.begin(link);
  follower.player_address = request.player_address;
  follower.page_address = request.page_address;
  // If the follower has records that are not durable, it compares them with the database first. So
  // it does if very many are not durable, because the database is slow.
  const bool sends_rest = feed.keeps_unwritten() && request.after.seq <= order_.durable() &&
                          feed.unwritten().parts().size() <= kUnwrittenSentMax;
  feed.send(link, encode_message(FollowAnswer{sends_rest ? order_.durable() : order_.head()}));
  if (sends_rest) {
    for (const LogPart& part : feed.unwritten().parts()) feed.send(link, encode_message(part));
  }
  feed.send(link, encode_message(receipts_.durable()));
  // The records that the follower reads set the clock, but do not have the present time of it.
  if (const auto time = order_.clock().at(now.steady_us)) feed.send(link, encode_message(*time));
}

std::optional<std::string> Followers::correction_refusal() const {
  for (const auto& [link, follower] : all_) {
    if (!follower.takes_corrections)
      return "A server that follows is of an older version, which cannot read a correction of the "
             "time: stop it, or start it with this version (servers lists them).";
  }
  return std::nullopt;
}

std::optional<std::string> Followers::library_refusal() const {
  for (const auto& [link, follower] : all_) {
    if (!follower.takes_library)
      return "a server that follows is of an older version, which cannot read a change of the library: "
             "stop it, or start it with this version (servers lists them)";
  }
  return std::nullopt;
}

std::optional<std::string> Followers::shapes_refusal() const {
  for (const auto& [link, follower] : all_) {
    if (!follower.takes_shapes)
      return "a server that follows is of an older version, which cannot read shapes of materials: "
             "stop it, or start it with this version (servers lists them)";
  }
  return std::nullopt;
}

std::optional<std::string> Followers::textures_refusal() const {
  for (const auto& [link, follower] : all_) {
    if (!follower.takes_textures)
      return "a server that follows is of an older version, which cannot read textures: stop it, "
             "or start it with this version (servers lists them)";
  }
  return std::nullopt;
}

std::optional<std::string> Followers::clock_refusal() const {
  for (const auto& [link, follower] : all_) {
    if (!follower.takes_clock)
      return "a server that follows is of an older version, which cannot read the clock of the world: "
             "stop it, or start it with this version (servers lists them)";
  }
  return std::nullopt;
}

std::optional<std::string> Followers::timed_grant_refusal() const {
  for (const auto& [link, follower] : all_) {
    if (!follower.takes_timed_grants)
      return "a server that follows is of an older version, which cannot read a role for some time: "
             "stop it, or start it with this version (servers lists them)";
  }
  return std::nullopt;
}

void Followers::admit(Session& session, const Clocks& now) {
  const SessionId link = session.id;
  environment_.report(OperatorLogLevel::info,
                      "follower=" + std::to_string(link) + " another server follows this one");
  sessions_.release(session);
  // An earlier connection of the same server would keep the sessions of its players.
  const auto earlier = std::ranges::find_if(
      all_, [&](const auto& entry) { return entry.second.instance == session.instance; });
  if (earlier != all_.end())
    close(earlier->first, GoodbyeReason::already_connected, "it connected again");
  Follower& follower = all_[link];
  follower.last_message_us = now.steady_us;
  follower.instance = session.instance;
  follower.takes_servers = session.has(kFeatureServerList);
  follower.takes_corrections = session.has(kFeatureTimeCorrections);
  follower.takes_library = session.has(kFeatureLibrary);
  follower.takes_shapes = session.has(kFeatureShapeRecords);
  follower.takes_textures = session.has(kFeatureTextureRecords);
  follower.takes_clock = session.has(kFeatureClockRecords);
  follower.takes_timed_grants = session.has(kFeatureTimedGrants);
  order_.feed().add(link);
  environment_.trust(link);
  environment_.opened(link);
  order_.feed().send(link, encode_message(SessionAccepted{}));
}

std::optional<RelayedMessage> Followers::received(SessionId link, const Message& message,
                                                  const Clocks& now) {
  all_.at(link).last_message_us = now.steady_us;
  if (std::holds_alternative<Goodbye>(message)) {
    environment_.close(link, GoodbyeReason::closing, "the follower said goodbye");
    forget(link);
    return std::nullopt;
  }
  if (const auto refusal =
          refusal_of(info_of(message), Sender::client, SessionStage::open, kFeatureServers)) {
    close(link, refusal->reason, refusal->text);
    return std::nullopt;
  }
  if (const auto* ping = std::get_if<Ping>(&message)) {
    static_cast<void>(environment_.send(link, encode_message(Pong{ping->sent_us, now.steady_us})));
    return std::nullopt;
  }
  // This server has handed the world over. What its followers send now, they send again to the next
  // owner.
  if (order_.is_following()) return std::nullopt;
  if (const auto* open = std::get_if<RelayOpen>(&message)) {
    on_relay_open(link, *open, now);
  } else if (const auto* relay = std::get_if<Relay>(&message)) {
    return on_relay(link, *relay, now);
  } else if (const auto* end = std::get_if<RelayClose>(&message)) {
    on_relay_close(link, *end);
  } else if (const auto* request = std::get_if<FollowRequest>(&message)) {
    on_follow_request(link, *request, now);
  }
  return std::nullopt;
}

void Followers::forget(SessionId link) {
  const auto found = all_.find(link);
  if (found == all_.end()) return;
  const Follower gone = std::move(found->second);
  all_.erase(found);
  order_.feed().remove(link);
  for (const auto& [remote, session] : gone.sessions) {
    if (Session* const there = sessions_.find(session)) sessions_.leave(*there);
  }
}

void Followers::forget_session(const Session& session) {
  const RelayedSession* there = sessions_.relayed(session.id);
  if (there == nullptr) return;
  const auto follower = all_.find(there->link);
  if (follower != all_.end()) follower->second.sessions.erase(there->remote);
}

void Followers::close_lost(const Clocks& now) {
  std::vector<std::pair<SessionId, const char*>> lost;
  for (const auto& [link, follower] : all_) {
    if (order_.feed().is_full(link)) {
      lost.emplace_back(link, "the follower reads too slowly");
    } else if (now.steady_us - follower.last_message_us >= kFollowerSilentUsMax) {
      lost.emplace_back(link, "no message for too long");
    }
  }
  for (const auto& [link, why] : lost) close(link, GoodbyeReason::timed_out, why);
  if (order_.is_following() && now.steady_us >= kept_until_us_)
    close_all("this server does not own the world any more");
}

void Followers::close_all(const std::string& text) {
  while (!all_.empty()) {
    const SessionId link = all_.begin()->first;
    environment_.close(link, GoodbyeReason::closing, text);
    forget(link);
  }
}

void Followers::keep_without_log(SessionId successor) {
  kept_until_us_ = std::numeric_limits<TimeUs>::max();
  std::vector<SessionId> fresh;
  for (const auto& [link, follower] : all_) {
    if (!order_.feed().gets_records(link)) fresh.push_back(link);
  }
  for (const SessionId link : fresh) {
    environment_.close(link, GoodbyeReason::closing, kConnectAgain);
    forget(link);
  }
  order_.feed().pause_all();
  for (auto& [link, follower] : all_) {
    for (const auto& [remote, session] : std::exchange(follower.sessions, {})) {
      if (Session* const there = sessions_.find(session)) sessions_.leave(*there);
    }
  }
  environment_.close(successor, GoodbyeReason::closing, "it hands the world over to this server");
  forget(successor);
}

void Followers::send_durable() {
  if (all_.empty()) return;
  order_.feed().send_to_served(encode_message(receipts_.durable()), order_.is_following());
}

}  // namespace runstone
