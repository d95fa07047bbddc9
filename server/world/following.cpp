#include "server/world/following.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <utility>
#include <variant>

#include "common/core/assert.hpp"
#include "server/world/broadcast.hpp"
#include "server/world/followers.hpp"
#include "server/world/handshake_handlers.hpp"
#include "server/world/listed_servers.hpp"
#include "server/world/material_handlers.hpp"
#include "server/world/request_handlers.hpp"
#include "server/world/rights_handlers.hpp"
#include "server/world/world_state.hpp"

namespace runstone {
namespace {

using Link = Following::Link;

constexpr TimeUs kPingIntervalUs = 1'000'000;
constexpr TimeUs kOwnerSilentUsMax = 5'000'000;
constexpr TimeUs kReadPauseUs = 20'000;
constexpr std::size_t kWaitingMax = 65'536;
constexpr std::size_t kForwardedMax = 65'536;
// Rows of players and names without records have no sequence that tells when they are durable. They are
// written within some 50 ms.
constexpr TimeUs kRowsKeptUs = 10'000'000;
constexpr const char* kTakenOver = "another server has taken the world over";

void leave(WorldState& world, const std::string& why) {
  world.environment.leave_owner(why);
  owner_disconnected(world);
}

/// Sends, or leaves the owner if it takes nothing.
bool send(WorldState& world, const Message& message) {
  if (world.environment.send_to_owner(encode_message(message))) return true;
  leave(world, "the owner reads too slowly");
  return false;
}

bool is_live(const WorldState& world) { return world.following->link == Link::live; }

/// Tells the owner of a session. Its player has proved a key.
bool send_session(WorldState& world, SessionId session, WorldSession& mine) {
  RelayOpen open;
  open.session = session;
  open.address = static_cast<std::uint64_t>(mine.address);
  open.is_encrypted = mine.binding.has_value();
  open.key = mine.key;
  open.instance = mine.instance;
  open.name = mine.name;
  // A session that was opened while this server owned the world may have more.
  open.features = mine.features & world.config.features;
  open.author = mine.state == SessionStage::open ? mine.author : 0;
  open.pose = mine.pose;
  if (mine.join) {
    open.ticket = mine.join->ticket;
    open.password_key = mine.join->password_key;
  }
  mine.is_at_owner = true;
  return send(world, open);
}

bool send_from(WorldState& world, SessionId session, const Message& message) {
  return send(world, Relay{{session}, encode_message(message)});
}

/// Tells the owner of all sessions.
void send_all_sessions(WorldState& world) {
  for (auto& [id, session] : world.sessions) {
    const bool joins = session.state == SessionStage::authenticating && session.join.has_value();
    if (session.state != SessionStage::open && !joins) continue;
    if (!send_session(world, id, session)) return;
  }
}

/// Measures how long edits of players here have waited.
void add_waits(WorldState& world, std::span<const LogPartRecord> records, const Clocks& now) {
  if (!world.following) return;
  auto& forwarded = world.following->forwarded;
  for (const LogPartRecord& one : records) {
    const auto found = forwarded.find(one.record.op);
    if (found == forwarded.end()) continue;
    world.authority.add_edit_wait(now.steady_us - found->second);
    forwarded.erase(found);
  }
}

void follow_records(WorldState& world, std::span<const LogPartRecord> records, const Clocks& now) {
  while (!records.empty()) {
    const Epoch epoch = records.front().record.version.epoch;
    const auto other = std::ranges::find_if(
        records, [epoch](const LogPartRecord& part) { return part.record.version.epoch != epoch; });
    const auto same = records.first(static_cast<std::size_t>(other - records.begin()));
    if (epoch > world.authority.epoch()) begin_epoch(world, epoch);
    add_waits(world, same, now);
    const OrderedBatch batch = world.authority.follow(same, now);
    apply_rights(world, batch.records);
    apply_materials(world, batch.records);
    publish_batch(world, batch, now);
    records = records.subspan(same.size());
  }
}

// Messages of the owner.

void on_welcome(WorldState& world, const Welcome& welcome) {
  Following& mine = *world.following;
  const PublicKey& key = world.config.server_keys.public_key;
  const Bytes transcript = server_transcript(mine.hello, welcome, mine.binding);
  if (welcome.world_id != world.config.world_id || welcome.server_key != key ||
      !verify(key, transcript, welcome.signature))
    return leave(world, "what answers there is no server of this world");
  if ((welcome.features & kFeatureServers) == 0)
    return leave(world, "the server there does not let others follow");
  if (welcome.epoch < world.authority.last_epoch()) return leave(world, kTakenOver);
  mine.link = Link::authenticating;
  mine.owner_epoch = welcome.epoch;
  const Bytes own = client_transcript(mine.hello, welcome, mine.binding);
  send(world, ClientAuth{sign(world.config.server_keys, own), "", std::nullopt});
}

void ask_for_log(WorldState& world) {
  const Sequence head = world.authority.head();
  world.following->link = Link::asking;
  send(world, FollowRequest{{world.authority.epoch(), head},
                            world.config.player_address,
                            world.config.page_address});
}

void go_live(WorldState& world, const Clocks& now) {
  Following& mine = *world.following;
  mine.link = Link::live;
  if (mine.owner_epoch > world.authority.epoch()) begin_epoch(world, mine.owner_epoch);
  world.environment.report(OperatorLogLevel::info,
                           "follows the owner from seq=" + std::to_string(world.authority.head()));
  // If this server owned the world before, followers may still be connected. They look for the next owner
  // now.
  close_followers(world, "another server owns the world");
  send_all_sessions(world);
  while (mine.link == Link::live && !mine.waiting.empty()) {
    Message next = std::move(mine.waiting.front());
    mine.waiting.pop_front();
    on_owner_message(world, std::move(next), now);
  }
}

void read_more(WorldState& world) {
  if (std::exchange(world.following->is_reading, true)) return;
  // The last record that is known is read again: its epoch shows whether the log is still the same.
  world.environment.read_log(std::max<Sequence>(1, world.authority.head()));
}

void on_follow_answer(WorldState& world, const FollowAnswer& answer, const Clocks& now) {
  Following& mine = *world.following;
  mine.read_to = answer.head;
  if (world.authority.head() > answer.head) {
    mine.has_forked = true;
    return leave(world, "the owner has fewer edits than this server");
  }
  if (world.authority.head() == answer.head && mine.not_durable.empty()) return go_live(world, now);
  mine.link = Link::reading;
  read_more(world);
}

void on_log_part(WorldState& world, LogPart part, const Clocks& now) {
  // The database may have shown records that the owner had only just ordered.
  std::erase_if(part.records, [head = world.authority.head()](const LogPartRecord& one) {
    return one.record.version.seq <= head;
  });
  if (!part.records.empty()) {
    const Version& first = part.records.front().record.version;
    const Sequence next = world.authority.head() + 1;
    if (first.seq != next)
      return leave(world, "the owner's next record is " + std::to_string(first.seq) + ", and not " +
                              std::to_string(next));
    if (first.epoch < world.authority.last_epoch()) return leave(world, kTakenOver);
  }
  apply_log_part(world, part, now);
  world.following->not_durable.push_back({std::move(part), now.steady_us});
}

void on_owner_durable(WorldState& world, const Durable& durable, const Clocks& now) {
  auto& kept = world.following->not_durable;
  const auto is_durable = [&](const KeptPart& front) {
    const auto& records = front.part.records;
    return records.empty() ? now.steady_us - front.received_us >= kRowsKeptUs
                           : records.back().record.version.seq <= durable.seq;
  };
  std::erase_if(kept, is_durable);
  if (world.disk_is_full != durable.is_read_only) {
    world.disk_is_full = durable.is_read_only;
    world.durable_due_us = 0;
  }
  const Sequence seq = std::min(durable.seq, world.authority.head());
  if (seq <= world.durable) return;
  world.durable = seq;
  send_durable_to_authors(world);
}

/// Opens a session that the owner has let in, or lets it go on.
void on_relayed_accept(WorldState& world, SessionId session, const SessionAccepted& accepted,
                       const Clocks& now) {
  const WorldSession* mine = world.find(session);
  if (mine == nullptr) return;
  if (mine->state == SessionStage::open) return send_resume(world, session, accepted.resolved);
  if (mine->state == SessionStage::authenticating) open_let_in(world, session, accepted, now);
}

void on_relayed_reject(WorldState& world, SessionId session, Reject reject) {
  WorldSession* mine = world.find(session);
  if (mine == nullptr || mine->state != SessionStage::open) return;
  mine->awaits_durable = std::max(mine->awaits_durable, reject.seq);
  world.following->forwarded.erase({mine->author, mine->instance, reject.client_seq});
  send_reject(world, session, std::move(reject));
}

void on_relay(WorldState& world, const Relay& relay, const Clocks& now) {
  const MessageKind kind = relay.message.kind;
  if (kind == kKindOf<SessionAccepted> || kind == kKindOf<Reject>) {
    auto message =
        decode_message(Sender::server, kind, *relay.message.bytes, world.config.chunk_edge);
    if (!message) return leave(world, "a relayed message does not decode");
    const SessionId session = relay.sessions.front();
    if (const auto* accepted = std::get_if<SessionAccepted>(&*message))
      return on_relayed_accept(world, session, *accepted, now);
    return on_relayed_reject(world, session, std::move(std::get<Reject>(*message)));
  }
  for (const SessionId session : relay.sessions) {
    const WorldSession* mine = world.find(session);
    if (mine == nullptr || mine->state != SessionStage::open) continue;
    if (send_or_skip(world, session, relay.message)) continue;
    // A change of the list of players makes sense only after the one before.
    if (kind == kKindOf<PlayerList>)
      close_session(world, session, GoodbyeReason::timed_out,
                    "send queue full: the peer reads too slowly");
  }
}

void on_live_message(WorldState& world, const Message& message, const Clocks& now) {
  if (const auto* part = std::get_if<LogPart>(&message)) return on_log_part(world, *part, now);
  if (const auto* durable = std::get_if<Durable>(&message))
    return on_owner_durable(world, *durable, now);
  if (const auto* relay = std::get_if<Relay>(&message)) return on_relay(world, *relay, now);
  if (const auto* close = std::get_if<RelayClose>(&message)) {
    if (WorldSession* mine = world.find(close->session)) {
      mine->is_at_owner = false;
      close_session(world, close->session, static_cast<GoodbyeReason>(close->reason), close->text);
    }
    return;
  }
  if (const auto* servers = std::get_if<Servers>(&message))
    return take_listed_servers(world, *servers);
  if (const auto* charge = std::get_if<RelayCharge>(&message))
    world.output.charge_reading(charge->session, charge->bytes);
}

}  // namespace

void begin_following(WorldState& world) {
  world.unwritten.clear();
  world.following = std::make_unique<Following>();
  world.following->owner_features = world.config.features & kFeaturesOfOwner;
  world.config.features &= ~kFeaturesOfOwner;
}

std::optional<std::string> take_read(WorldState& world, const ReadLog& read, const Clocks& now) {
  const Sequence head = world.authority.head();
  if (read.last < head) return std::nullopt;
  std::vector<LogPartRecord> records;
  bool has_head = head == 0;
  for (const EditRecord& record : read.records) {
    const Version& version = record.version;
    if (version.seq == head) has_head = version.epoch == world.authority.last_epoch();
    if (version.seq > head) records.push_back({record, 0});
  }
  if (!has_head) return "the log has other edits than this server";
  for (const PlayerRow& row : read.players) world.players.restore(row);
  world.names.follow_all(read.names);
  follow_records(world, records, now);
  return std::nullopt;
}

void owner_connected(WorldState& world, const std::optional<ChannelBinding>& binding,
                     const Clocks& now) {
  Following& mine = *world.following;
  if (mine.is_taking_over) return world.environment.leave_owner("this server takes over");
  mine.link = Link::greeting;
  mine.binding = binding;
  mine.heard_us = mine.pinged_us = now.steady_us;
  mine.waiting.clear();
  const ClientInstance earlier = mine.hello.instance;
  mine.hello = {};
  mine.hello.key = world.config.server_keys.public_key;
  mine.hello.name = "server";
  mine.hello.features = kFeatureServers | kFeatureServerList;
  // The same on each connection, so that the owner knows which one it replaces.
  mine.hello.instance = earlier;
  if (earlier == 0) {
    std::array<std::uint8_t, sizeof mine.hello.instance> instance{};
    world.random(instance);
    std::memcpy(&mine.hello.instance, instance.data(), sizeof mine.hello.instance);
  }
  world.random(mine.hello.nonce);
  send(world, mine.hello);
}

void on_owner_message(WorldState& world, Message&& message, const Clocks& now) {
  Following& mine = *world.following;
  if (mine.link == Link::none) return;
  mine.heard_us = now.steady_us;
  if (const auto* goodbye = std::get_if<Goodbye>(&message))
    return leave(world, "the owner said goodbye: " + goodbye->text);
  if (std::holds_alternative<Pong>(message)) return;
  if (const auto* welcome = std::get_if<Welcome>(&message)) {
    if (mine.link == Link::greeting) return on_welcome(world, *welcome);
  } else if (std::holds_alternative<SessionAccepted>(message)) {
    if (mine.link == Link::authenticating) return ask_for_log(world);
  } else if (const auto* answer = std::get_if<FollowAnswer>(&message)) {
    if (mine.link == Link::asking) return on_follow_answer(world, *answer, now);
  } else if (mine.link == Link::reading) {
    mine.waiting.push_back(std::move(message));
    if (mine.waiting.size() > kWaitingMax) leave(world, "the database is too slow to follow");
    return;
  } else if (mine.link == Link::live) {
    return on_live_message(world, message, now);
  }
  leave(world, "the owner sent a message that does not belong here");
}

void owner_disconnected(WorldState& world) {
  Following& mine = *world.following;
  mine.link = Link::none;
  mine.waiting.clear();
  mine.forwarded.clear();
  for (auto& [id, session] : world.sessions) {
    session.is_at_owner = false;
    session.needs_resume = session.state == SessionStage::open;
  }
}

void on_log_read(WorldState& world, const Result<ReadLog, std::string>& read, const Clocks& now) {
  Following& mine = *world.following;
  mine.is_reading = false;
  if (mine.link != Link::reading) return;
  if (!read) return leave(world, read.error());
  if (const auto why = take_read(world, *read, now)) {
    mine.has_forked = true;
    return leave(world, *why);
  }
  if (world.authority.last_epoch() > mine.owner_epoch) return leave(world, kTakenOver);
  if (world.authority.head() >= mine.read_to && read->last >= world.authority.head()) {
    // The database has them. Rows without records that it lacks were lost with an earlier owner.
    std::erase_if(mine.not_durable, [last = read->last](const KeptPart& kept) {
      const auto& records = kept.part.records;
      return records.empty() || records.back().record.version.seq <= last;
    });
    return go_live(world, now);
  }
  // The rest is not durable yet, or there is more than one read returns.
  mine.read_again_us = now.steady_us + (read->last > world.authority.head() ? 0 : kReadPauseUs);
}

void tick_following(WorldState& world, const Clocks& now) {
  Following& mine = *world.following;
  if (mine.link == Link::none) return;
  if (now.steady_us - mine.heard_us >= kOwnerSilentUsMax)
    return leave(world, "the owner has sent nothing for too long");
  const bool is_open = mine.link == Link::reading || mine.link == Link::live;
  if (is_open && now.steady_us - mine.pinged_us >= kPingIntervalUs) {
    mine.pinged_us = now.steady_us;
    if (!send(world, Ping{now.steady_us})) return;
  }
  if (mine.link == Link::reading && !mine.is_reading && now.steady_us >= mine.read_again_us)
    read_more(world);
}

void join_at_owner(WorldState& world, SessionId session, const ClientAuth& auth) {
  WorldSession& mine = *world.find(session);
  mine.auth_transcript = {};
  mine.is_authenticated = true;
  mine.join = auth;
  world.environment.opened(session);
  if (is_live(world)) send_session(world, session, mine);
}

bool on_message_for_owner(WorldState& world, SessionId session, const Message& message,
                          const Clocks& now) {
  WorldSession& mine = *world.find(session);
  const bool reaches_owner = is_live(world) && mine.is_at_owner;
  if (const auto* edit = std::get_if<EditRequest>(&message)) {
    const bool is_refused = edit->action != 0 && edit->action == mine.refused_action;
    if (edit->fault || is_refused) {
      mine.refused_action = edit->action;
      mine.refused_reason = RejectReason::bad_edit;
      world.output.charge_reading(session, kRejectionBytes);
      send_reject(world, session,
                  {edit->client_seq, RejectReason::bad_edit,
                   edit->fault ? fault_text(*edit->fault) : kActionRefused, 0});
    } else if (reaches_owner) {
      auto& forwarded = world.following->forwarded;
      if (forwarded.size() < kForwardedMax)
        forwarded.try_emplace({mine.author, mine.instance, edit->client_seq}, now.steady_us);
      send_from(world, session, *edit);
    }
    return true;
  }
  if (const auto* move = std::get_if<Move>(&message)) {
    on_move(world, session, *move, now);
    if (reaches_owner) send_from(world, session, *move);
    return true;
  }
  if (const auto* command = std::get_if<CommandRequest>(&message)) {
    if (reaches_owner) {
      send_from(world, session, *command);
    } else {
      CommandOutput out;
      out.id = command->id;
      out.lines = {"the server that carries out commands does not answer: try again in a moment"};
      out.is_done = true;
      send_or_skip(world, session, encode_message(out));
    }
    return true;
  }
  if (const auto* chat = std::get_if<ChatRequest>(&message)) {
    if (reaches_owner) send_from(world, session, *chat);
    return true;
  }
  return false;
}

void session_left(WorldState& world, SessionId session, const WorldSession& mine) {
  auto& forwarded = world.following->forwarded;
  auto edit = forwarded.lower_bound({mine.author, mine.instance, 0});
  while (edit != forwarded.end() && edit->first.author == mine.author &&
         edit->first.instance == mine.instance)
    edit = forwarded.erase(edit);
  if (!mine.is_at_owner || !is_live(world)) return;
  static_cast<void>(world.environment.send_to_owner(encode_message(RelayClose{session, 1, ""})));
}

void apply_log_part(WorldState& world, const LogPart& part, const Clocks& now) {
  for (const LogPlayer& row : part.players) world.players.restore({row.author, row.key, row.name});
  for (const LogName& name : part.names)
    world.names.follow({{name.folded, name.name, name.key}, name.is_release});
  follow_records(world, part.records, now);
}

void send_resume(WorldState& world, SessionId session, ClientSequence resolved) {
  WorldSession& mine = *world.find(session);
  if ((mine.features & kFeatureResume) == 0)
    return close_session(world, session, GoodbyeReason::closing, kConnectAgain);
  mine.needs_resume = false;
  ++mine.resumes_unanswered;
  send_or_close(world, session, Resume{resolved});
}

void begin_epoch(WorldState& world, Epoch epoch) {
  world.authority.begin_epoch(epoch);
  for (const SessionId session : world.open_sessions()) send_epoch(world, session);
}

void send_epoch(WorldState& world, SessionId session) {
  WorldSession& mine = *world.find(session);
  if (mine.is_relayed || mine.epoch == world.authority.epoch()) return;
  mine.epoch = world.authority.epoch();
  if ((mine.features & kFeatureResume) == 0) {
    return close_session(world, session, GoodbyeReason::closing, kConnectAgain);
  }
  // It precedes the commits of the epoch, which the client would refuse otherwise.
  if (!world.output.send(session, encoded_durable(world)))
    close_session(world, session, GoodbyeReason::timed_out,
                  "send queue full: the peer reads too slowly");
}

}  // namespace runstone
