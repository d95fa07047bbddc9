#include "client/replica/client_session.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "client/replica/view_size.hpp"
#include "common/core/assert.hpp"
#include "common/core/text.hpp"

namespace runstone {

ClientSession::ClientSession(SessionConfig config) : connection_(std::move(config)) {
  if (connection_.config().has_cache) replica_.keep_chunks();
}

// ---- the connection

void ClientSession::connected(const Nonce& nonce, TimeUs now_us) {
  disconnected();
  connection_.connected(nonce, now_us);
}

void ClientSession::disconnected() {
  connection_.disconnected();
  waiting_.clear();
  view_waits_since_us_.reset();
  asked_.clear();
  questions_.clear();
  answers_stale_ += std::exchange(answers_due_, 0);
  others_.clear();
  travel_request_ = travelled_ = 0;
  travel_refusal_.clear();
  if (is_commanding_) command_lines_ = {"the connection ended before the answer came"};
  is_commanding_ = false;
  early_.clear();
}

void ClientSession::receive(Message message, const Arrival& arrival) {
  if (connection_.accepts_input()) now_us_ = arrival.now_us;
  switch (connection_.receive(message, arrival)) {
    case ServerConnection::Dispatch::handled:
      return;
    case ServerConnection::Dispatch::another_world:
      return replica_.reset();
    case ServerConnection::Dispatch::ready:
      return on_session_accepted(std::get<SessionAccepted>(message), arrival.now_us);
    case ServerConnection::Dispatch::for_session:
      break;
  }
  std::visit(
      [&](auto& m) {
        using T = std::decay_t<decltype(m)>;
        if (state() == SessionState::proving && early_.size() < kEarlyMessagesMax) {
          early_.emplace_back(std::move(m), arrival);
        } else if (!is_open()) {
          connection_.fail_with(GoodbyeReason::unexpected_message, "message before ready");
        } else if constexpr (std::is_same_v<T, ChunkSnapshot>) {
          replica_.receive(std::move(m), arrival);
        } else if constexpr (std::is_same_v<T, ChunkEdits>) {
          replica_.receive(m, arrival);
        } else if constexpr (std::is_same_v<T, ChunksNotModified>) {
          replica_.receive(m, arrival.now_us);
        } else if constexpr (std::is_same_v<T, UniformChunks>) {
          replica_.receive(m, arrival);
        } else if constexpr (std::is_same_v<T, ChunkUnavailable>) {
          replica_.receive(m);
        } else if constexpr (std::is_same_v<T, Commit>) {
          const auto taken = replica_.receive(m, arrival);
          if (!taken) connection_.fail_with(GoodbyeReason::malformed_message, taken.error().what);
        } else if constexpr (std::is_same_v<T, Reject> || std::is_same_v<T, DigestCheck>) {
          replica_.receive(m, arrival.now_us);
        } else if constexpr (std::is_same_v<T, Durable>) {
          replica_.receive(m);
        } else if constexpr (std::is_same_v<T, HistoryState>) {
          on_history_state(m);
        } else if constexpr (std::is_same_v<T, PlayerPoses>) {
          on_poses(m);
        } else if constexpr (std::is_same_v<T, PlayerList>) {
          on_player_list(m);
        } else if constexpr (std::is_same_v<T, CommandOutput>) {
          on_command_output(std::move(m));
        } else {
          connection_.fail_with(GoodbyeReason::unexpected_message, "message of a client");
        }
      },
      message);
}

void ClientSession::on_session_accepted(const SessionAccepted& ready, TimeUs now_us) {
  const Welcome& world = *welcome();
  opened_us_ = now_us;
  replica_.set_view(view());
  waiting_ = replica_.open({.chunk_edge = world.chunk_edge,
                            .author = ready.author,
                            .instance = connection_.config().instance,
                            .epoch = world.epoch,
                            .durable = world.durable,
                            .head = world.head,
                            .resolved = ready.resolved,
                            .heights = world.heights,
                            .edit_volume_max = world.edit_volume_max});
  wish_view();
  tick(now_us);
  for (auto& [message, arrival] : std::exchange(early_, {})) receive(std::move(message), arrival);
}

// ---- while open

void ClientSession::tick(TimeUs now_us) {
  const bool is_offset_wanted = pongs() < kPingsFirst || !clock().known();
  if (!connection_.tick(now_us, is_offset_wanted ? kPingEveryFirstUs : kPingEveryUs)) return;
  now_us_ = now_us;
  if (view_waits_since_us_ && now_us - *view_waits_since_us_ >= kCacheWaitUsMax) send_view();
  replica_.tick(now_us);
  connection_.request_chunks(replica_.take_requests());
  send_waiting_edits(now_us);
}

Result<ClientSequence> ClientSession::submit(const EditDescriptor& edit, TimeUs submitted_us,
                                             TimeUs now_us) {
  if (const auto valid = validate(edit); !valid) return Unexpected<Error>{valid.error()};
  if (welcome() && !welcome()->materials.knows(material_max(edit))) {
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
    for (const auto& [seq, own] : replica_.local_edits().all()) {
      if (own.resolved && !own.asked) continue;
      if (own.sent_us == OwnEdit::kNever || now_us - own.sent_us < kAnswerUsMax) break;
      waiting_.push_back(seq);
    }
  }
  if (waiting_.empty()) return;
  // Without a clock offset the others could not tell how old the edit is.
  if (!clock().known() && now_us - opened_us_ < kOffsetWaitUsMax) return;
  for (const ClientSequence seq : std::exchange(waiting_, {})) {
    const auto it = replica_.local_edits().all().find(seq);
    if (it == replica_.local_edits().all().end() || (it->second.resolved && !it->second.asked))
      continue;
    connection_.send_edit(seq, it->second);
    replica_.mark_sent(seq, now_us);
  }
}

void ClientSession::set_view(const View& view) {
  connection_.set_view(view);
  const View wished = this->view();
  if (!replica_.view() || !replica_.view()->same_chunks(wished)) replica_.set_view(wished);
  if (is_open()) wish_view();
}

Result<void> ClientSession::command(std::string text) {
  if (!is_open()) return fail(ErrorCode::bad_value, "no world is open");
  if ((welcome()->features & kFeatureCommands) == 0) {
    return fail(ErrorCode::unknown_kind, "the server takes no commands");
  }
  if (is_commanding_) return fail(ErrorCode::bad_value, "the command before is still under way");
  if (text.empty() || text.size() > kCommandBytesMax || !is_printable_utf8(text)) {
    return fail(ErrorCode::bad_value, "a command is 1 to 1024 bytes of text");
  }
  is_commanding_ = true;
  is_command_ok_ = false;
  command_lines_.clear();
  connection_.send(CommandRequest{++command_, std::move(text)});
  return {};
}

void ClientSession::on_command_output(CommandOutput output) {
  if (!is_commanding_ || output.id != command_)
    return;  // of a command that a lost connection ended
  for (std::string& line : output.lines) {
    if (command_lines_.size() < kCommandLinesKept) command_lines_.push_back(std::move(line));
  }
  is_commanding_ = !output.is_done;
  is_command_ok_ = output.is_done && output.is_ok;
}

Result<void> ClientSession::travel(HistoryRequest travel) {
  if (!is_open()) return fail(ErrorCode::bad_value, "no world is open");
  travel.request = ++travel_request_;
  travel_refusal_.clear();
  connection_.send(travel);
  return {};
}

void ClientSession::on_history_state(const HistoryState& moment) {
  const bool is_newest = moment.request == travel_request_;
  if (moment.phase == HistoryPhase::begins) {
    replica_.begin_moment(moment.past ? std::optional(PastMoment{moment.seq, moment.utc_us})
                                      : std::nullopt);
    if (is_newest && !moment.past)
      travelled_ = moment.request;  // its chunks are counted like any others
  } else if (is_newest) {
    travelled_ = moment.request;
    if (moment.phase == HistoryPhase::refused) travel_refusal_ = moment.text;
  }
}

void ClientSession::wish_view() {
  if (connection_.config().has_cache) {
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
  return CachedWorld{welcome()->world_id,
                     welcome()->chunk_edge,
                     {welcome()->epoch, replica_.durable(), replica_.newest()}};
}

void ClientSession::send_view() {
  view_waits_since_us_.reset();
  for (Message& held : cached_chunks_messages(replica_.take_claims()))
    connection_.send(std::move(held));
  connection_.send_view();
}

std::size_t ClientSession::view_chunks() const { return chunks_in(view()); }

bool ClientSession::loaded() const {
  return is_open() && !travelling() &&
         replica_.current_count() + replica_.unavailable_count() == view_chunks() &&
         replica_.awaiting_count() == 0;
}

void ClientSession::on_player_list(const PlayerList& roster) {
  std::map<AuthorId, OtherPlayer> known = std::exchange(others_, {});
  if (roster.is_change) std::swap(known, others_);
  for (const AuthorId author : roster.left) others_.erase(author);
  for (const PlayerName& player : roster.players) {
    if (player.author == author()) continue;
    OtherPlayer& other = others_[player.author];
    other.name = player.name;
    if (const auto before = known.find(player.author); before != known.end())
      other.pose = before->second.pose;
  }
}

void ClientSession::on_poses(const PlayerPoses& poses) {
  for (const PlayerPose& player : poses.players) {
    if (player.author != author()) others_[player.author].pose = player.pose;
  }
}

}  // namespace runstone
