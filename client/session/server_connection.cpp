#include "client/session/server_connection.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

bool is_final(GoodbyeReason reason) {
  return reason == GoodbyeReason::wrong_protocol || reason == GoodbyeReason::not_authenticated ||
         reason == GoodbyeReason::name_refused || reason == GoodbyeReason::not_admitted;
}

}  // namespace

// Connection.

void ServerConnection::connected(const Nonce& nonce, const std::optional<ChannelBinding>& binding,
                                 TimeUs now_us, bool is_listed) {
  disconnected();
  end_.reset();
  lacks_password_ = false;
  hello_ = make_hello(config_, nonce);
  binding_ = binding;
  is_listed_ = is_listed;
  outgoing_.push_back(hello_);
  state_ = SessionState::hello_sent;
  last_message_us_ = now_us;
}

void ServerConnection::disconnected() {
  state_ = SessionState::offline;
  outgoing_.clear();
  view_sent_.reset();
  pose_sent_.reset();
  wants_close_ = false;
}

ServerConnection::Dispatch ServerConnection::receive(Message& message, const Arrival& arrival) {
  if (!accepts_input()) return Dispatch::handled;
  last_message_us_ = arrival.now_us;
  if (const auto* goodbye = std::get_if<Goodbye>(&message)) {
    // Before its welcome, whatever answers at an address of the list may be no server of this
    // world.
    const bool is_proved = !is_listed_ || state_ != SessionState::hello_sent;
    end_ = SessionEnd{goodbye->reason, goodbye->text, true, is_proved && is_final(goodbye->reason)};
    lacks_password_ = state_ == SessionState::authenticating && welcome_->password_salt &&
                      !config_.password && goodbye->reason == GoodbyeReason::not_admitted;
    wants_close_ = true;
    return Dispatch::handled;
  }
  const std::uint64_t features = welcome_ ? welcome_->features : 0;
  if (const auto refusal = refusal_of(info_of(message), Sender::server, stage(), features)) {
    fail_with(refusal->reason, refusal->text);
    return Dispatch::handled;
  }
  if (auto* welcome = std::get_if<Welcome>(&message)) return on_welcome(std::move(*welcome));
  if (const auto* accepted = std::get_if<SessionAccepted>(&message)) {
    on_session_accepted(*accepted, arrival.now_us);
    return Dispatch::session_accepted;
  }
  if (const auto* pong = std::get_if<Pong>(&message); pong != nullptr && is_open()) {
    clock_.add(pong->sent_us, pong->server_us, arrival.received_us);
    ++pongs_;
    return Dispatch::handled;
  }
  if (const auto* added = std::get_if<MaterialsAdded>(&message); added != nullptr && is_open())
    return on_materials(*added);
  if (const auto* shapes = std::get_if<ShapesGiven>(&message); shapes != nullptr && is_open())
    return on_shapes(*shapes);
  if (const auto* time = std::get_if<WorldTime>(&message); time != nullptr && is_open()) {
    time_ = *time;
    time_us_ = arrival.received_us;
    return Dispatch::handled;
  }
  if (auto* servers = std::get_if<Servers>(&message); servers != nullptr && is_open()) {
    servers_ = std::move(*servers);
    ++servers_number_;
    return Dispatch::handled;
  }
  if (const auto* durable = std::get_if<Durable>(&message); durable != nullptr && is_open()) {
    // Another server has taken the world over, and nothing is lost.
    if ((welcome_->features & kFeatureResume) != 0)
      welcome_->epoch = std::max(welcome_->epoch, durable->epoch);
  }
  return Dispatch::for_session;
}

SessionStage ServerConnection::stage() const {
  RUNSTONE_ASSERT(state_ != SessionState::offline);
  if (state_ == SessionState::hello_sent) return SessionStage::greeting;
  return state_ == SessionState::authenticating ? SessionStage::authenticating : SessionStage::open;
}

std::optional<WelcomeFault> ServerConnection::fault_of(const Welcome& welcome) {
  // The key of another world would be pinned as one that the user has met.
  if (is_listed_ && (!welcome_ || welcome_->world_id != welcome.world_id))
    return WelcomeFault{GoodbyeReason::closing, "a listed server has another world"};
  return check_welcome(hello_, welcome, binding_, config_.pinned);
}

ServerConnection::Dispatch ServerConnection::on_welcome(Welcome welcome) {
  if (const auto fault = fault_of(welcome)) {
    if (!is_listed_) return give_up(fault->reason, fault->text);
    fail_with(fault->reason, fault->text);
    return Dispatch::handled;
  }
  ClientAuth auth{sign(config_.keys, client_transcript(hello_, welcome, binding_)), config_.ticket};
  const bool is_another_world = welcome_ && welcome_->world_id != welcome.world_id;
  // Whoever receives the key of the password can join with it. So it is sent only to the world for
  // which the player typed the password.
  if (config_.password && welcome.password_salt && !is_another_world) {
    if (!binding_)
      return give_up(GoodbyeReason::closing, "a password is sent on encrypted connections only");
    const auto key = config_.password->key_for(*welcome.password_salt);
    if (!key) return give_up(GoodbyeReason::closing, key.error());
    auth.password_key = *key;
  }
  // Each of several servers has a clock of its own.
  const bool is_another_clock = is_another_world ||
                                (welcome_ && welcome_->epoch != welcome.epoch) ||
                                !servers_.servers.empty();
  if (is_another_clock) clock_.reset();
  if (is_another_world) {
    servers_ = {};
    ++servers_number_;
  }
  if (is_another_world || (welcome.features & kFeatureWorldTime) == 0) time_.reset();
  outgoing_.push_back(std::move(auth));
  welcome_ = std::move(welcome);
  state_ = SessionState::authenticating;
  return is_another_world ? Dispatch::another_world : Dispatch::handled;
}

ServerConnection::Dispatch ServerConnection::give_up(GoodbyeReason reason,
                                                     const std::string& text) {
  end_ = SessionEnd{reason, text, false, true};
  close(reason, text);
  return Dispatch::handled;
}

void ServerConnection::set_password(std::shared_ptr<PasswordKeys> password) {
  config_.password = std::move(password);
  lacks_password_ = false;
  end_.reset();
}

void ServerConnection::on_session_accepted(const SessionAccepted& accepted, TimeUs now_us) {
  author_ = accepted.author;
  place_ = (welcome_->features & kFeatureVisits) != 0 ? accepted.place : std::nullopt;
  ++connect_count_;
  state_ = SessionState::open;
  ping_us_ = now_us - kPingEveryUs;
  move_us_ = now_us - kMoveEveryUs;
}

ServerConnection::Dispatch ServerConnection::on_materials(const MaterialsAdded& added) {
  const auto appended = welcome_->materials.append(added.first, added.rows);
  if (appended) return Dispatch::materials_added;
  fail_with(GoodbyeReason::malformed_message, appended.error().what);
  return Dispatch::handled;
}

ServerConnection::Dispatch ServerConnection::on_shapes(const ShapesGiven& shapes) {
  const auto given = welcome_->materials.give_shapes(shapes.given.rows);
  if (given) {
    ++shapes_number_;
    return Dispatch::materials_added;
  }
  fail_with(GoodbyeReason::malformed_message, given.error().what);
  return Dispatch::handled;
}

void ServerConnection::close(GoodbyeReason reason, std::string text) {
  if (accepts_input()) outgoing_.push_back(Goodbye{reason, std::move(text)});
  wants_close_ = true;
}

void ServerConnection::fail_with(GoodbyeReason reason, std::string text) {
  end_ = SessionEnd{reason, text, false, false};
  close(reason, std::move(text));
}

// Sending.

bool ServerConnection::tick(TimeUs now_us, TimeUs ping_every_us) {
  if (!accepts_input()) return false;
  if (now_us - last_message_us_ > kServerSilenceUsMax) {
    fail_with(GoodbyeReason::timed_out, "server is silent");
    return false;
  }
  if (!is_open()) return false;
  if (now_us - ping_us_ >= ping_every_us) {
    outgoing_.push_back(Ping{now_us});
    ping_us_ = now_us;
  }
  if (now_us - move_us_ >= kMoveEveryUs && pose_sent_ != pose_) {
    outgoing_.push_back(Move{pose_});
    pose_sent_ = pose_;
    move_us_ = now_us;
  }
  return true;
}

TimeUs ServerConnection::tick_due_us(TimeUs ping_every_us) const {
  if (state_ == SessionState::offline) return std::numeric_limits<TimeUs>::max();
  TimeUs due_us = last_message_us_ + kServerSilenceUsMax + 1;
  if (!is_open()) return due_us;
  due_us = std::min(due_us, ping_us_ + ping_every_us);
  if (pose_sent_ != pose_) due_us = std::min(due_us, move_us_ + kMoveEveryUs);
  return due_us;
}

void ServerConnection::send_edit(ClientSequence seq, const LocalEdit& local) {
  EditRequest request{seq, clock_.to_server(local.submitted_us).value_or(0), local.edit};
  request.action = local.action;
  request.is_optional = local.is_optional && (welcome_->features & kFeatureLargeActions) != 0;
  outgoing_.push_back(std::move(request));
}

void ServerConnection::request_chunks(const std::vector<ChunkKey>& keys) {
  for (std::size_t first = 0; first < keys.size(); first += kChunkRequestKeysMax) {
    const std::size_t last = std::min(keys.size(), first + kChunkRequestKeysMax);
    outgoing_.push_back(ChunkRequest{{keys.begin() + static_cast<std::ptrdiff_t>(first),
                                      keys.begin() + static_cast<std::ptrdiff_t>(last)}});
  }
}

View ServerConnection::view() const {
  View view = config_.view;
  const std::uint8_t limit = welcome_ ? welcome_->view_radius_max : std::uint8_t{kViewRadiusMax};
  view.radius_h = std::min(view.radius_h, limit);
  view.radius_v = std::min(view.radius_v, limit);
  const bool has_tiles = welcome_ && (welcome_->features & kFeatureTiles) != 0;
  view.levels = has_tiles ? std::min(view.levels, welcome_->tile_levels_max) : std::uint8_t{0};
  view.number = view_sent_ ? view_sent_->number : 0;
  if (view != view_sent_) ++view.number;
  return view;
}

bool ServerConnection::send_view() {
  const View view = this->view();
  if (view_sent_ == view) return false;
  outgoing_.push_back(view);
  view_sent_ = view;
  return true;
}

std::vector<Message> ServerConnection::take_outgoing() { return std::exchange(outgoing_, {}); }

}  // namespace runstone
