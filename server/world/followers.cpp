#include "server/world/followers.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <variant>

#include "common/core/assert.hpp"
#include "server/world/chat_handlers.hpp"
#include "server/world/command_handlers.hpp"
#include "server/world/handshake_handlers.hpp"
#include "server/world/request_handlers.hpp"
#include "server/world/world_state.hpp"

namespace runstone {
namespace {

void close_follower(WorldState& world, SessionId link, GoodbyeReason reason,
                    const std::string& text) {
  world.environment.report(OperatorLogLevel::warn,
                           "follower=" + std::to_string(link) + " closed text=\"" + text + "\"");
  world.environment.close(link, reason, text);
  forget_follower(world, link);
}

/// Sends to every follower that gets the log. One that cannot take the message is closed later, because
/// that closes sessions, and the caller may be in the middle of one.
void send_to_followers(WorldState& world, const EncodedMessage& message) {
  for (auto& [link, follower] : world.followers) {
    if (is_served(follower) && !world.environment.send(link, message)) follower.is_full = true;
  }
}

void add_rows(const std::vector<PlayerRow>& rows, LogPart& part) {
  for (const PlayerRow& row : rows) part.players.push_back({row.author, row.key, row.name});
}

/// Returns the number of records from `first` on that one message may hold.
std::size_t records_that_fit(const std::vector<EditRecord>& records, std::size_t first) {
  if (records.size() == first + 1) return 1;
  constexpr std::size_t kOverhead = 128;  // of a record besides its descriptor, at most
  std::size_t bytes = 0, count = 0;
  while (first + count < records.size() && count < kLogPartRecordsMax) {
    bytes += kOverhead + encode(records[first + count].edit).size();
    if (count > 0 && bytes > kLogPartBytesMax) break;
    ++count;
  }
  return count;
}

// More would fill the queue of the connection.
constexpr std::size_t kUnwrittenSentMax = 8'192;

/// Returns true if a server may follow this one, now or later.
bool may_be_followed(const WorldState& world) {
  return world.config.may_be_followed || has_live_followers(world);
}

/// Sends what is appended to the log next to the followers, and keeps it for those that come.
void pass_on(WorldState& world, LogPart part) {
  if (world.config.may_be_followed) world.unwritten.add(part);
  if (has_live_followers(world)) send_to_followers(world, encode_message(std::move(part)));
}

void pass_on_batch(WorldState& world, const std::vector<PlayerRow>& players,
                   const OrderedBatch& batch) {
  const std::vector<EditRecord>& records = batch.records;
  for (std::size_t first = 0; first < records.size();) {
    LogPart part;
    part.epoch = world.authority.epoch();
    if (first == 0) add_rows(players, part);
    const std::size_t end = first + records_that_fit(records, first);
    for (; first < end; ++first)
      part.records.push_back({records[first], batch.commit.edits[first].submitted_us});
    pass_on(world, std::move(part));
  }
}

/// Returns true if a player may send this message through another server.
bool may_be_relayed(const Message& message) {
  return std::holds_alternative<EditRequest>(message) || std::holds_alternative<Move>(message) ||
         std::holds_alternative<CommandRequest>(message) ||
         std::holds_alternative<ChatRequest>(message);
}

void on_relay_open(WorldState& world, SessionId link, const RelayOpen& open, const Clocks& now) {
  if (world.followers.at(link).sessions.contains(open.session))
    return close_follower(world, link, GoodbyeReason::unexpected_message, "a session twice");
  const SessionId session = world.output.add({link, open.session});
  world.followers.at(link).sessions[open.session] = session;
  WorldSession fresh;
  fresh.is_relayed = true;
  fresh.connected_us = fresh.last_message_us = now.steady_us;
  world.sessions.emplace(session, std::move(fresh));
  join_relayed(world, session, open, now);
}

void on_relay(WorldState& world, SessionId link, const Relay& relay, const Clocks& now) {
  const auto& sessions = world.followers.at(link).sessions;
  const auto found = sessions.find(relay.sessions.front());
  if (found == sessions.end()) return;  // it was closed here while the message was under way
  const SessionId session = found->second;
  WorldSession& mine = *world.find(session);
  mine.last_message_us = now.steady_us;
  if (!may_send(info_of(relay.message.kind), Sender::client))
    return close_follower(world, link, GoodbyeReason::unexpected_message, "not of a player");
  const auto message = decode_message(Sender::client, relay.message.kind, *relay.message.bytes,
                                      world.config.chunk_edge);
  // The follower has verified it, so the follower is to blame.
  if (!message || !may_be_relayed(*message))
    return close_follower(world, link, GoodbyeReason::malformed_message, "a bad relayed message");
  ++world.counters.messages;
  if (const auto refusal = refusal_of(info_of(*message), Sender::client, mine.state, mine.features))
    return close_session(world, session, refusal->reason, refusal->text);
  if (const auto* edit = std::get_if<EditRequest>(&*message))
    return on_edit(world, session, *edit, now);
  if (const auto* move = std::get_if<Move>(&*message)) return on_move(world, session, *move, now);
  if (const auto* command = std::get_if<CommandRequest>(&*message))
    return on_command(world, session, *command, now);
  on_chat(world, session, std::get<ChatRequest>(*message), now);
}

void on_relay_close(WorldState& world, SessionId link, const RelayClose& close) {
  const auto& sessions = world.followers.at(link).sessions;
  const auto found = sessions.find(close.session);
  if (found != sessions.end()) forget_session(world, found->second);
}

void on_follow_request(WorldState& world, SessionId link, const FollowRequest& request) {
  if (!world.environment.owns_world())
    return close_follower(world, link, GoodbyeReason::closing, "another server may own the world");
  Follower& follower = world.followers.at(link);
  follower.gets_log = true;
  follower.player_address = request.player_address;
  follower.page_address = request.page_address;
  const auto send = [&](const EncodedMessage& message) {
    if (!follower.is_full) follower.is_full = !world.environment.send(link, message);
  };
  // If the follower has records that are not durable, it compares them with the database first. So it
  // does if very many are not durable, because the database is slow.
  const bool sends_rest = world.config.may_be_followed && request.after.seq <= world.durable &&
                          world.unwritten.parts().size() <= kUnwrittenSentMax;
  send(encode_message(FollowAnswer{sends_rest ? world.durable : world.authority.head()}));
  if (sends_rest) {
    for (const LogPart& part : world.unwritten.parts()) send(encode_message(part));
  }
  send(encoded_durable(world));
}

}  // namespace

void admit_follower(WorldState& world, SessionId link, const Clocks& now) {
  world.environment.report(OperatorLogLevel::info,
                           "follower=" + std::to_string(link) + " another server follows this one");
  const ClientInstance instance = world.find(link)->instance;
  const std::uint64_t features = world.find(link)->features;
  world.sessions.erase(link);
  // An earlier connection of the same server would keep the sessions of its players.
  for (const auto& [other, follower] : world.followers) {
    if (follower.instance != instance) continue;
    close_follower(world, other, GoodbyeReason::already_connected, "it connected again");
    break;
  }
  Follower& follower = world.followers[link];
  follower.last_message_us = now.steady_us;
  follower.instance = instance;
  follower.takes_servers = (features & kFeatureServerList) != 0;
  world.environment.trust(link);
  world.environment.opened(link);
  follower.is_full = !world.environment.send(link, encode_message(SessionAccepted{}));
}

void on_follower_message(WorldState& world, SessionId link, const Message& message,
                         const Clocks& now) {
  world.followers.at(link).last_message_us = now.steady_us;
  if (std::holds_alternative<Goodbye>(message)) {
    world.environment.close(link, GoodbyeReason::closing, "the follower said goodbye");
    return forget_follower(world, link);
  }
  if (const auto refusal =
          refusal_of(info_of(message), Sender::client, SessionStage::open, kFeatureServers))
    return close_follower(world, link, refusal->reason, refusal->text);
  if (const auto* ping = std::get_if<Ping>(&message)) {
    static_cast<void>(
        world.environment.send(link, encode_message(Pong{ping->sent_us, now.steady_us})));
    return;
  }
  // This server has handed the world over. What its followers send now, they send again to the next
  // owner.
  if (world.following) return;
  if (const auto* open = std::get_if<RelayOpen>(&message))
    return on_relay_open(world, link, *open, now);
  if (const auto* relay = std::get_if<Relay>(&message)) return on_relay(world, link, *relay, now);
  if (const auto* close = std::get_if<RelayClose>(&message))
    return on_relay_close(world, link, *close);
  if (const auto* request = std::get_if<FollowRequest>(&message))
    return on_follow_request(world, link, *request);
}

void forget_follower(WorldState& world, SessionId link) {
  const auto found = world.followers.find(link);
  if (found == world.followers.end()) return;
  const Follower gone = std::move(found->second);
  world.followers.erase(found);
  for (const auto& [remote, session] : gone.sessions) forget_session(world, session);
}

void close_lost_followers(WorldState& world, const Clocks& now) {
  std::vector<std::pair<SessionId, const char*>> lost;
  for (const auto& [link, follower] : world.followers) {
    if (follower.is_full) {
      lost.emplace_back(link, "the follower reads too slowly");
    } else if (now.steady_us - follower.last_message_us >= kFollowerSilentUsMax) {
      lost.emplace_back(link, "no message for too long");
    }
  }
  for (const auto& [link, why] : lost) close_follower(world, link, GoodbyeReason::timed_out, why);
}

bool has_live_followers(const WorldState& world) {
  return std::ranges::any_of(world.followers,
                             [](const auto& entry) { return is_served(entry.second); });
}

void close_followers(WorldState& world, const std::string& text) {
  while (!world.followers.empty()) {
    const SessionId link = world.followers.begin()->first;
    world.environment.close(link, GoodbyeReason::closing, text);
    forget_follower(world, link);
  }
}

void append_to_log(WorldState& world, std::vector<PlayerRow> players, OrderedBatch& batch) {
  if (may_be_followed(world)) pass_on_batch(world, players, batch);
  world.environment.log_append(std::move(players), std::move(batch.records));
}

void append_players(WorldState& world, std::vector<PlayerRow> players) {
  if (may_be_followed(world)) {
    LogPart part;
    part.epoch = world.authority.epoch();
    add_rows(players, part);
    pass_on(world, std::move(part));
  }
  world.environment.log_append(std::move(players), {});
}

void append_names(WorldState& world, std::vector<NameChange> changes) {
  if (may_be_followed(world)) {
    for (const auto& [claim, is_release] : changes) {
      LogPart part;
      part.epoch = world.authority.epoch();
      part.names.push_back({claim.folded, claim.name, claim.key, is_release});
      pass_on(world, std::move(part));
    }
  }
  world.environment.log_names(std::move(changes));
}

void send_durable_to_followers(WorldState& world) {
  if (world.followers.empty()) return;
  const EncodedMessage message = encoded_durable(world);
  for (auto& [link, follower] : world.followers) {
    // A former owner still has those to which it has sent the last records.
    const bool is_wanted = world.following ? !follower.is_full : is_served(follower);
    if (is_wanted && !world.environment.send(link, message)) follower.is_full = true;
  }
}

}  // namespace runstone
