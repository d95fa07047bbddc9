#include "server/world/cluster/players_at_owner.hpp"

#include <utility>
#include <variant>

namespace runstone {
namespace {

constexpr std::size_t kForwardedMax = 65'536;

}  // namespace

/// Tells the owner of a session. Its player has proved a key.
bool PlayersAtOwner::send_session(const Session& session) {
  RelayOpen open;
  open.session = session.id;
  open.address = static_cast<std::uint64_t>(session.address);
  open.is_encrypted = session.binding.has_value();
  open.key = session.key;
  open.instance = session.instance;
  open.name = session.name;
  // A session that was opened while this server owned the world may have more.
  open.features = joining_.offered_features() & session.features;
  open.author = session.is_open() ? session.author : 0;
  open.pose = session.pose;
  if (const auto join = joins_.find(session.id); join != joins_.end()) {
    open.ticket = join->second.ticket;
    open.password_key = join->second.password_key;
  }
  known_.insert(session.id);
  return link_.send(open);
}

bool PlayersAtOwner::join(Session& session, const ClientAuth& auth) {
  joining_.set_authenticated(session);
  session.awaits_owner = true;
  joins_[session.id] = {auth.ticket, auth.password_key};
  return !link_.is_live() || send_session(session);
}

bool PlayersAtOwner::send_all() {
  for (const Session* session : std::as_const(sessions_).all()) {
    if (!session->is_open() && !joins_.contains(session->id)) continue;
    if (!send_session(*session)) return false;
  }
  return true;
}

/// Sends the message to the owner, if it knows of the session.
PassedOn PlayersAtOwner::pass_on(const Session& session, const Message& message) {
  if (!link_.is_live() || !known_.contains(session.id)) return PassedOn::yes;
  const bool is_sent = link_.send(Relay{{session.id}, encode_message(message)});
  return is_sent ? PassedOn::yes : PassedOn::full;
}

PassedOn PlayersAtOwner::on_message(Session& session, const Message& message, const Clocks& now) {
  const bool reaches_owner = link_.is_live() && known_.contains(session.id);
  if (const auto* edit = std::get_if<EditRequest>(&message)) {
    if (edits_.reject_invalid(session, *edit)) return PassedOn::yes;
    if (reaches_owner && forwarded_.size() < kForwardedMax)
      forwarded_.try_emplace({session.author, session.instance, edit->client_seq}, now.steady_us);
    return pass_on(session, message);
  }
  if (const auto* move = std::get_if<Move>(&message)) {
    presence_.on_move(session, *move, now);
    return pass_on(session, message);
  }
  if (const auto* command = std::get_if<CommandRequest>(&message)) {
    if (reaches_owner) return pass_on(session, message);
    CommandOutput out;
    out.id = command->id;
    out.lines = {"the server that carries out commands does not answer: try again in a moment"};
    out.is_done = true;
    sessions_.send_or_skip(session, encode_message(out));
    return PassedOn::yes;
  }
  return std::holds_alternative<ChatRequest>(message) ? pass_on(session, message) : PassedOn::no;
}

void PlayersAtOwner::add_waits(std::span<const LogPartRecord> records, const Clocks& now) {
  for (const LogPartRecord& one : records) {
    const auto found = forwarded_.find(one.record.op);
    if (found == forwarded_.end()) continue;
    order_.authority().add_edit_wait(now.steady_us - found->second);
    forwarded_.erase(found);
  }
}

void PlayersAtOwner::disconnected() {
  known_.clear();
  forwarded_.clear();
}

bool PlayersAtOwner::forget(const Session& session) {
  joins_.erase(session.id);
  auto edit = forwarded_.lower_bound({session.author, session.instance, 0});
  while (edit != forwarded_.end() && edit->first.author == session.author &&
         edit->first.instance == session.instance)
    edit = forwarded_.erase(edit);
  if (known_.erase(session.id) == 0 || !link_.is_live()) return true;
  constexpr auto kClosing = static_cast<std::uint8_t>(GoodbyeReason::closing);
  return link_.send(RelayClose{session.id, kClosing, ""});
}

std::vector<std::pair<Session*, JoinCredentials>> PlayersAtOwner::take_joining() {
  std::vector<std::pair<Session*, JoinCredentials>> joining;
  for (auto& [id, brought] : std::exchange(joins_, {})) {
    Session* const session = sessions_.find(id);
    if (session == nullptr) continue;
    session->awaits_owner = false;
    joining.emplace_back(session, std::move(brought));
  }
  return joining;
}

}  // namespace runstone
