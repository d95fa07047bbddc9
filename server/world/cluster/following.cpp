#include "server/world/cluster/following.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <variant>

namespace runstone {
namespace {

using Stage = OwnerLink::Stage;

constexpr TimeUs kReadPauseUs = 20'000;
constexpr std::size_t kWaitingMax = 65'536;
// Rows of players and names without records have no sequence that tells when they are durable. They
// are written within some 50 ms.
constexpr TimeUs kRowsKeptUs = 10'000'000;

}  // namespace

void Following::begin() {
  world_.order.feed().clear_unwritten();
  world_.link.begin();
  read_to_ = 0;
  read_again_us_ = 0;
  not_durable_.clear();
  disconnected();
}

std::vector<LogPart> Following::stop() {
  disconnected();
  std::vector<LogPart> parts;
  for (const KeptPart& kept : not_durable_) parts.push_back(kept.part);
  return parts;
}

bool Following::catch_up(const ReadLog& read, const Clocks& now) {
  return take(read, now) && world_.order.head() == read.last;
}

void Following::leave(const std::string& why) {
  world_.environment.leave_owner(why);
  disconnected();
}

void Following::disconnected() {
  world_.link.set_stage(Stage::none);
  waiting_.clear();
  world_.players.disconnected();
  for (const Session* session : world_.sessions.open()) world_.resumes.ignore_edits(*session);
}

void Following::connected(const std::optional<ChannelBinding>& binding, const Clocks& now) {
  const OwnershipState state = world_.order.ownership().state();
  if (state == OwnershipState::taking_over || state == OwnershipState::takeover_failed)
    return world_.environment.leave_owner("this server takes over");
  waiting_.clear();
  if (!world_.link.connected(binding, now)) leave_slow();
}

/// Takes what a reader has found. Fails if the log is not the one that this server has followed: its
/// record at the head of this server has another epoch.
Result<void, std::string> Following::take(const ReadLog& read, const Clocks& now) {
  const Version known = world_.order.last_record();
  if (read.last < known.seq) return {};
  std::vector<LogPartRecord> records;
  bool has_head = known.seq == 0;
  for (const EditRecord& record : read.records) {
    const Version& version = record.version;
    if (version.seq == known.seq) has_head = version.epoch == known.epoch;
    if (version.seq > known.seq) records.push_back({record, 0});
  }
  if (!has_head) return failure("the log has other edits than this server");
  for (const PlayerRow& row : read.players) world_.order.players().restore(row);
  world_.order.names().restore_all(read.names);
  apply_ordered(records, now);
  return {};
}

/// Applies records that another server has ordered, and sends them to the sessions.
void Following::apply_ordered(std::span<const LogPartRecord> records, const Clocks& now) {
  world_.players.add_waits(records, now);
  world_.commits.apply_ordered(records, now);
}

// Messages of the owner.

void Following::go_live(const Clocks& now) {
  world_.link.set_stage(Stage::live);
  if (world_.link.owner_epoch() > world_.order.epoch())
    world_.commits.begin_epoch(world_.link.owner_epoch());
  world_.environment.report(OperatorLogLevel::info,
                            "follows the owner from seq=" + std::to_string(world_.order.head()));
  // If this server owned the world before, followers may still be connected. They look for the next
  // owner now.
  world_.followers.close_all("another server owns the world");
  if (!world_.players.send_all()) return leave_slow();
  while (world_.link.is_live() && !waiting_.empty()) {
    Message next = std::move(waiting_.front());
    waiting_.pop_front();
    received(std::move(next), now);
  }
}

void Following::read_more() {
  if (std::exchange(is_reading_, true)) return;
  // The last record that is known is read again: its epoch shows whether the log is still the same.
  world_.environment.read_missed_log(std::max<Sequence>(1, world_.order.head()));
}

void Following::on_follow_answer(const FollowAnswer& answer, const Clocks& now) {
  read_to_ = answer.head;
  if (world_.order.head() > answer.head) {
    world_.order.ownership().find_fork();
    return leave("the owner has fewer edits than this server");
  }
  if (world_.order.head() == answer.head && not_durable_.empty()) return go_live(now);
  world_.link.set_stage(Stage::reading);
  read_more();
}

void Following::on_log_part(LogPart part, const Clocks& now) {
  const Version known = world_.order.last_record();
  // The database may have shown records that the owner had only just ordered.
  std::erase_if(part.records,
                [&](const LogPartRecord& one) { return one.record.version.seq <= known.seq; });
  if (!part.records.empty()) {
    const Version& first = part.records.front().record.version;
    if (first.seq != known.seq + 1)
      return leave("the owner's next record is " + std::to_string(first.seq) + ", and not " +
                   std::to_string(known.seq + 1));
    if (first.epoch < known.epoch) return leave(kTakenOver);
  }
  for (const LogPlayer& row : part.players)
    world_.order.players().restore({row.author, row.key, row.name});
  for (const LogName& name : part.names)
    world_.order.names().apply({{name.folded, name.name, name.key}, name.is_release});
  apply_ordered(part.records, now);
  if (!part.records.empty())
    world_.order.authority().log_clock().hear_owner(part.records.back().record.time_us, now);
  not_durable_.push_back({std::move(part), now.steady_us});
}

void Following::on_durable(const Durable& durable, const Clocks& now) {
  const auto is_durable = [&](const KeptPart& kept) {
    const auto& records = kept.part.records;
    return records.empty() ? now.steady_us - kept.received_us >= kRowsKeptUs
                           : records.back().record.version.seq <= durable.seq;
  };
  std::erase_if(not_durable_, is_durable);
  if (world_.order.is_disk_full() != durable.is_read_only) {
    world_.order.set_disk_is_full(durable.is_read_only);
    world_.receipts.hurry_durable();
  }
  if (world_.order.set_durable(std::min(durable.seq, world_.order.head())))
    world_.receipts.send_durable_to_authors();
}

/// Opens a session that the owner has let in, or lets it go on.
void Following::on_relayed_accept(Session& session, const SessionAccepted& accepted,
                                  const Clocks& now) {
  if (session.is_open()) return world_.resumes.send(session, accepted.resolved);
  if (session.stage != SessionStage::authenticating) return;
  world_.players.accepted(session);
  world_.joining.open_let_in(session, accepted, now);
}

void Following::on_relayed_reject(Session& session, Reject reject) {
  if (!session.is_open()) return;
  world_.receipts.expect_durable(session, reject.seq);
  world_.players.rejected({session.author, session.instance, reject.client_seq});
  world_.receipts.reject(session, std::move(reject));
}

void Following::on_relay(const Relay& relay, const Clocks& now) {
  const MessageKind kind = relay.message.kind;
  if (kind == kKindOf<SessionAccepted> || kind == kKindOf<Reject>) {
    auto message =
        decode_message(Sender::server, kind, *relay.message.bytes, world_.config.chunk_edge);
    if (!message) return leave("a relayed message does not decode");
    Session* const session = world_.sessions.find(relay.sessions.front());
    if (session == nullptr) return;
    if (const auto* accepted = std::get_if<SessionAccepted>(&*message))
      return on_relayed_accept(*session, *accepted, now);
    return on_relayed_reject(*session, std::move(std::get<Reject>(*message)));
  }
  std::vector<SessionId> open;
  for (const SessionId id : relay.sessions) {
    const Session* const session = world_.sessions.find(id);
    if (session != nullptr && session->is_open()) open.push_back(id);
  }
  const std::vector<SessionId> full = world_.sessions.send_to_all(open, relay.message);
  // A change of the list of players makes sense only after the one before.
  if (kind != kKindOf<PlayerList>) return;
  for (const SessionId id : full) {
    if (Session* const session = world_.sessions.find(id)) world_.sessions.close_slow(*session);
  }
}

void Following::on_live_message(const Message& message, const Clocks& now) {
  if (const auto* part = std::get_if<LogPart>(&message)) {
    on_log_part(*part, now);
  } else if (const auto* durable = std::get_if<Durable>(&message)) {
    on_durable(*durable, now);
  } else if (const auto* relay = std::get_if<Relay>(&message)) {
    on_relay(*relay, now);
  } else if (const auto* close = std::get_if<RelayClose>(&message)) {
    if (Session* const session = world_.sessions.find(close->session)) {
      world_.players.closed_by_owner(*session);
      world_.sessions.close(*session, static_cast<GoodbyeReason>(close->reason), close->text);
    }
  } else if (const auto* servers = std::get_if<Servers>(&message)) {
    world_.servers.take(*servers);
  } else if (const auto* time = std::get_if<WorldTime>(&message)) {
    world_.order.clock().correct(*time, now.steady_us);
    world_.receipts.send_time_to_all(now);
  } else if (const auto* charge = std::get_if<RelayCharge>(&message)) {
    if (const Session* session = world_.sessions.find(charge->session))
      world_.sessions.charge_reading(*session, charge->bytes);
  }
}

void Following::received(Message&& message, const Clocks& now) {
  const Stage stage = world_.link.stage();
  if (stage == Stage::none) return;
  world_.link.heard(now);
  if (const auto* goodbye = std::get_if<Goodbye>(&message))
    return leave("the owner said goodbye: " + goodbye->text);
  if (std::holds_alternative<Pong>(message)) return;
  if (const auto* welcome = std::get_if<Welcome>(&message)) {
    if (stage == Stage::greeting) {
      if (const auto done = world_.link.on_welcome(*welcome); !done) leave(done.error());
      return;
    }
  } else if (std::holds_alternative<SessionAccepted>(message)) {
    if (stage == Stage::authenticating) {
      if (!world_.link.ask_for_log()) leave_slow();
      return;
    }
  } else if (const auto* answer = std::get_if<FollowAnswer>(&message)) {
    if (stage == Stage::asking) return on_follow_answer(*answer, now);
  } else if (stage == Stage::reading) {
    waiting_.push_back(std::move(message));
    if (waiting_.size() > kWaitingMax) leave("the database is too slow to follow");
    return;
  } else if (stage == Stage::live) {
    return on_live_message(message, now);
  }
  leave("the owner sent a message that does not belong here");
}

void Following::missed_log_read(const Result<ReadLog, std::string>& read, const Clocks& now) {
  is_reading_ = false;
  if (world_.link.stage() != Stage::reading) return;
  if (!read) return leave(read.error());
  if (const auto taken = take(*read, now); !taken) {
    world_.order.ownership().find_fork();
    return leave(taken.error());
  }
  const Version known = world_.order.last_record();
  if (known.epoch > world_.link.owner_epoch()) return leave(kTakenOver);
  if (known.seq >= read_to_ && read->last >= known.seq) {
    // The database has them. Rows without records that it lacks were lost with an earlier owner.
    std::erase_if(not_durable_, [last = read->last](const KeptPart& kept) {
      const auto& records = kept.part.records;
      return records.empty() || records.back().record.version.seq <= last;
    });
    return go_live(now);
  }
  // The rest is not durable yet, or there is more than one read returns.
  read_again_us_ = now.steady_us + (read->last > known.seq ? 0 : kReadPauseUs);
}

void Following::tick(const Clocks& now) {
  if (const auto done = world_.link.tick(now); !done) return leave(done.error());
  if (world_.link.stage() == Stage::reading && !is_reading_ && now.steady_us >= read_again_us_)
    read_more();
}

void Following::join(Session& session, const ClientAuth& auth) {
  if (!world_.players.join(session, auth)) leave_slow();
}

void Following::forget(const Session& session) {
  if (!world_.players.forget(session)) leave_slow();
}

bool Following::on_message(Session& session, const Message& message, const Clocks& now) {
  const PassedOn passed = world_.players.on_message(session, message, now);
  if (passed == PassedOn::full) leave_slow();
  return passed != PassedOn::no;
}

}  // namespace runstone
