#include "client/replica/client_session.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "client/replica/view_size.hpp"
#include "common/core/assert.hpp"
#include "common/core/text.hpp"

namespace runstone {
namespace {

bool is_final(GoodbyeReason reason) {
  return reason == GoodbyeReason::wrong_protocol || reason == GoodbyeReason::not_authenticated;
}

}  // namespace

ClientSession::ClientSession(SessionConfig config) : config_(std::move(config)) {
  if (config_.has_cache) replica_.keep_chunks();
}

// ---- the connection

void ClientSession::connected(const Nonce& nonce, TimeUs now_us) {
  disconnected();
  end_.reset();
  hello_ = hello_of(config_, nonce);
  outgoing_.push_back(hello_);
  state_ = SessionState::greeting;
  heard_us_ = now_us;
}

void ClientSession::disconnected() {
  state_ = SessionState::offline;
  outgoing_.clear();
  waiting_.clear();
  view_sent_.reset();
  view_waits_since_us_.reset();
  asked_.clear();
  questions_.clear();
  answers_stale_ += std::exchange(answers_due_, 0);
  pose_sent_.reset();
  others_.clear();
  travel_request_ = travelled_ = 0;
  travel_refusal_.clear();
  if (is_commanding_) command_lines_ = {"the connection ended before the answer came"};
  is_commanding_ = false;
  early_.clear();
  wants_close_ = false;
}

std::vector<Message> ClientSession::take_outgoing() { return std::exchange(outgoing_, {}); }

void ClientSession::close(GoodbyeReason reason, std::string text) {
  if (state_ != SessionState::offline && !wants_close_) outgoing_.push_back(Goodbye{reason, std::move(text)});
  wants_close_ = true;
}

void ClientSession::fail_with(GoodbyeReason reason, std::string text, bool final) {
  end_ = SessionEnd{reason, text, false, final};
  close(reason, std::move(text));
}

void ClientSession::receive(Message message, const Arrival& arrival) {
  if (state_ == SessionState::offline || wants_close_) return;
  heard_us_ = now_us_ = arrival.now_us;
  std::visit(
      [&](auto& m) {
        using T = std::decay_t<decltype(m)>;
        if constexpr (std::is_same_v<T, Goodbye>) {
          on_goodbye(m);
        } else if constexpr (std::is_same_v<T, Welcome>) {
          if (state_ == SessionState::greeting) return on_welcome(std::move(m));
          fail_with(GoodbyeReason::unexpected_message, "welcome twice", false);
        } else if constexpr (std::is_same_v<T, Ready>) {
          if (state_ == SessionState::proving) return on_ready(m, arrival.now_us);
          fail_with(GoodbyeReason::unexpected_message, "ready out of turn", false);
        } else if (state_ == SessionState::proving && early_.size() < kEarlyMessagesMax) {
          early_.emplace_back(std::move(m), arrival);
        } else if (state_ != SessionState::open) {
          fail_with(GoodbyeReason::unexpected_message, "message before ready", false);
        } else if constexpr (std::is_same_v<T, ChunkSnapshot>) {
          replica_.receive(std::move(m), arrival);
        } else if constexpr (std::is_same_v<T, ChunkEdits>) {
          replica_.receive(m, arrival);
        } else if constexpr (std::is_same_v<T, Same>) {
          replica_.receive(m, arrival.now_us);
        } else if constexpr (std::is_same_v<T, UniformChunks>) {
          replica_.receive(m, arrival);
        } else if constexpr (std::is_same_v<T, ChunkUnavailable>) {
          replica_.receive(m);
        } else if constexpr (std::is_same_v<T, Commit>) {
          const auto taken = replica_.receive(m, arrival);
          if (!taken) fail_with(GoodbyeReason::malformed_message, taken.error().what, false);
        } else if constexpr (std::is_same_v<T, Reject> || std::is_same_v<T, Audit>) {
          replica_.receive(m, arrival.now_us);
        } else if constexpr (std::is_same_v<T, Durable>) {
          replica_.receive(m);
        } else if constexpr (std::is_same_v<T, Moment>) {
          on_moment(m);
        } else if constexpr (std::is_same_v<T, PlayerPoses>) {
          on_poses(m);
        } else if constexpr (std::is_same_v<T, Roster>) {
          on_roster(m);
        } else if constexpr (std::is_same_v<T, CommandOutput>) {
          on_command_output(std::move(m));
        } else if constexpr (std::is_same_v<T, Pong>) {
          clock_.add(m.sent_us, m.server_us, arrival.received_us);
          ++pongs_;
        } else {
          fail_with(GoodbyeReason::unexpected_message, "message of a client", false);
        }
      },
      message);
}

// ---- handshake

void ClientSession::on_welcome(Welcome welcome) {
  if (const auto fault = check_welcome(hello_, welcome, config_.pinned)) {
    return fail_with(fault->reason, fault->text, true);
  }
  if (welcome_ && welcome_->world_id != welcome.world_id) {
    replica_.reset();  // another world under the same address: nothing we hold means anything there
    clock_.reset();
  } else if (welcome_ && welcome_->epoch != welcome.epoch) {
    clock_.reset();
  }
  outgoing_.push_back(Proof{sign(config_.keys, client_transcript(hello_, welcome))});
  welcome_ = std::move(welcome);
  state_ = SessionState::proving;
}

void ClientSession::on_ready(const Ready& ready, TimeUs now_us) {
  author_ = ready.author;
  ++openings_;
  state_ = SessionState::open;
  opened_us_ = now_us;
  ping_us_ = now_us - kPingEveryUs;
  move_us_ = now_us - kMoveEveryUs;
  replica_.set_view(view());
  waiting_ = replica_.open({.chunk_edge = welcome_->chunk_edge,
                            .author = author_,
                            .instance = config_.instance,
                            .epoch = welcome_->epoch,
                            .durable = welcome_->durable,
                            .head = welcome_->head,
                            .decided = ready.decided,
                            .heights = welcome_->heights,
                            .edit_volume_max = welcome_->edit_volume_max});
  wish_view();
  tick(now_us);
  for (auto& [message, arrival] : std::exchange(early_, {})) receive(std::move(message), arrival);
}

void ClientSession::on_goodbye(const Goodbye& goodbye) {
  end_ = SessionEnd{goodbye.reason, goodbye.text, true, is_final(goodbye.reason)};
  wants_close_ = true;
}

// ---- while open

void ClientSession::tick(TimeUs now_us) {
  if (state_ == SessionState::offline || wants_close_) return;
  if (now_us - heard_us_ > kServerSilenceUsMax) {
    return fail_with(GoodbyeReason::timed_out, "server is silent", false);
  }
  now_us_ = now_us;
  if (!is_open()) return;
  if (view_waits_since_us_ && now_us - *view_waits_since_us_ >= kCacheWaitUsMax) send_view();
  const TimeUs every = pongs_ < kPingsFirst || !clock_.known() ? kPingEveryFirstUs : kPingEveryUs;
  if (now_us - ping_us_ >= every) {
    outgoing_.push_back(Ping{now_us});
    ping_us_ = now_us;
  }
  if (now_us - move_us_ >= kMoveEveryUs && pose_sent_ != pose_) {
    outgoing_.push_back(Move{pose_});
    pose_sent_ = pose_;
    move_us_ = now_us;
  }
  replica_.tick(now_us);
  const auto requests = replica_.take_requests();
  for (std::size_t first = 0; first < requests.size(); first += kChunkRequestKeysMax) {
    const std::size_t last = std::min(requests.size(), first + kChunkRequestKeysMax);
    outgoing_.push_back(ChunkRequest{{requests.begin() + static_cast<std::ptrdiff_t>(first),
                                      requests.begin() + static_cast<std::ptrdiff_t>(last)}});
  }
  send_waiting_edits(now_us);
}

Result<ClientSequence> ClientSession::submit(const EditDescriptor& edit, TimeUs submitted_us, TimeUs now_us) {
  if (const auto valid = validate(edit); !valid) return Unexpected<Error>{valid.error()};
  if (welcome_ && !welcome_->materials.knows(material_max(edit))) {
    return fail(ErrorCode::not_found, "material is not in the world's table");
  }
  const auto seq = replica_.submit(edit, submitted_us, now_us);
  if (seq && is_open()) {
    waiting_.push_back(*seq);
    send_waiting_edits(now_us);
  }
  return seq;
}

void ClientSession::send_waiting_edits(TimeUs now_us) {
  // An edit that got no answer: its commit was dropped on the way to us. The server tells by the operation id
  // whether it was decided, so asking twice does no harm.
  if (waiting_.empty()) {
    for (const auto& [seq, own] : replica_.own_edits().all()) {
      if (own.decided && !own.asked) continue;
      if (own.sent_us == OwnEdit::kNever || now_us - own.sent_us < kAnswerUsMax) break;
      waiting_.push_back(seq);
    }
  }
  if (waiting_.empty()) return;
  // Without a clock offset the others could not tell how old the edit is.
  if (!clock_.known() && now_us - opened_us_ < kOffsetWaitUsMax) return;
  for (const ClientSequence seq : std::exchange(waiting_, {})) {
    const auto it = replica_.own_edits().all().find(seq);
    if (it == replica_.own_edits().all().end() || (it->second.decided && !it->second.asked)) continue;
    outgoing_.push_back(
        EditRequest{seq, clock_.to_server(it->second.submitted_us).value_or(0), it->second.edit});
    replica_.mark_sent(seq, now_us);
  }
}

void ClientSession::set_view(const View& view) {
  config_.view = view;
  const View wished = this->view();
  if (!replica_.view() || !replica_.view()->same_chunks(wished)) replica_.set_view(wished);
  if (is_open()) wish_view();
}

Result<void> ClientSession::command(std::string text) {
  if (!is_open()) return fail(ErrorCode::bad_value, "no world is open");
  if ((welcome_->features & kFeatureCommands) == 0) {
    return fail(ErrorCode::unknown_kind, "the server takes no commands");
  }
  if (is_commanding_) return fail(ErrorCode::bad_value, "the command before is still under way");
  if (text.empty() || text.size() > kCommandBytesMax || !is_printable_utf8(text)) {
    return fail(ErrorCode::bad_value, "a command is 1 to 1024 bytes of text");
  }
  is_commanding_ = true;
  is_command_ok_ = false;
  command_lines_.clear();
  outgoing_.push_back(CommandRequest{++command_, std::move(text)});
  return {};
}

void ClientSession::on_command_output(CommandOutput output) {
  if (!is_commanding_ || output.id != command_) return;  // of a command that a lost connection ended
  for (std::string& line : output.lines) {
    if (command_lines_.size() < kCommandLinesKept) command_lines_.push_back(std::move(line));
  }
  is_commanding_ = !output.is_done;
  is_command_ok_ = output.is_done && output.is_ok;
}

Result<void> ClientSession::travel(Travel travel) {
  if (!is_open()) return fail(ErrorCode::bad_value, "no world is open");
  travel.request = ++travel_request_;
  travel_refusal_.clear();
  outgoing_.push_back(travel);
  return {};
}

void ClientSession::on_moment(const Moment& moment) {
  const bool is_newest = moment.request == travel_request_;
  if (moment.phase == MomentPhase::begins) {
    replica_.begin_moment(moment.past ? std::optional(PastMoment{moment.seq, moment.utc_us}) : std::nullopt);
    if (is_newest && !moment.past) travelled_ = moment.request;  // its chunks are counted like any others
  } else if (is_newest) {
    travelled_ = moment.request;
    if (moment.phase == MomentPhase::refused) travel_refusal_ = moment.text;
  }
}

View ClientSession::view() const {
  View view = config_.view;
  const std::uint8_t limit = welcome_ ? welcome_->view_radius_max : std::uint8_t{kViewRadiusMax};
  view.radius_h = std::min(view.radius_h, limit);
  view.radius_v = std::min(view.radius_v, limit);
  return view;
}

void ClientSession::wish_view() {
  if (config_.has_cache) {
    std::erase_if(asked_, [v = view()](const ChunkKey& key) { return !v.contains(key.at); });
    for (const ChunkKey& key : replica_.missing()) {
      if (asked_.insert(key).second) questions_.push_back(key);
    }
  }
  if (questions_.empty() && answers_due_ == 0) return send_view();
  if (!view_waits_since_us_) view_waits_since_us_ = now_us_;
}

std::optional<CacheQuestion> ClientSession::take_question() {
  const auto world = cached_world();
  if (!world || questions_.empty()) return std::nullopt;
  ++answers_due_;
  std::sort(questions_.begin(), questions_.end());
  return CacheQuestion{*world, std::exchange(questions_, {})};
}

void ClientSession::answer(std::vector<KeptChunk> found, TimeUs now_us) {
  if (answers_stale_ != 0) {
    --answers_stale_;  // to what an earlier connection asked: another server may be there now
    return;
  }
  RUNSTONE_ASSERT(answers_due_ != 0);
  --answers_due_;
  now_us_ = now_us;
  for (auto& [key, chunk] : found) replica_.adopt(key, std::move(chunk), now_us);
  if (answers_due_ == 0 && questions_.empty()) send_view();
}

std::optional<CachedWorld> ClientSession::cached_world() const {
  if (!is_open()) return std::nullopt;
  return CachedWorld{
      welcome_->world_id, welcome_->chunk_edge, {welcome_->epoch, replica_.durable(), replica_.newest()}};
}

void ClientSession::send_view() {
  view_waits_since_us_.reset();
  const View wished = view();
  for (Message& held : held_messages(replica_.take_claims())) outgoing_.push_back(std::move(held));
  if (view_sent_ == wished) return;
  outgoing_.push_back(wished);
  view_sent_ = wished;
}

std::size_t ClientSession::view_chunks() const { return chunks_in(view()); }

bool ClientSession::loaded() const {
  return is_open() && !travelling() &&
         replica_.current_count() + replica_.unavailable_count() == view_chunks() &&
         replica_.awaiting_count() == 0;
}

void ClientSession::on_roster(const Roster& roster) {
  std::map<AuthorId, OtherPlayer> known = std::exchange(others_, {});
  if (roster.is_change) std::swap(known, others_);
  for (const AuthorId author : roster.left) others_.erase(author);
  for (const PlayerName& player : roster.players) {
    if (player.author == author_) continue;
    OtherPlayer& other = others_[player.author];
    other.name = player.name;
    if (const auto before = known.find(player.author); before != known.end())
      other.pose = before->second.pose;
  }
}

void ClientSession::on_poses(const PlayerPoses& poses) {
  for (const PlayerPose& player : poses.players) {
    if (player.author != author_) others_[player.author].pose = player.pose;
  }
}

}  // namespace runstone
