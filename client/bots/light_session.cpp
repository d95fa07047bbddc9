#include "client/bots/light_session.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>

#include "client/replica/view_size.hpp"

namespace runstone {

LightSession::LightSession(SessionConfig config, CrowdBook& crowd, TimeUs (*clock)())
    : config_(std::move(config)), crowd_(crowd), clock_now_(clock) {
  on_walked_ = [this](const WalkedEdit& edit) { return on_edit(edit); };
}

// ---- the connection

void LightSession::connected(const Nonce& nonce, TimeUs now_us) {
  disconnected();
  end_.reset();
  hello_ = hello_of(config_, nonce);
  outgoing_.push_back(hello_);
  state_ = SessionState::greeting;
  heard_us_ = now_us;
}

void LightSession::disconnected() {
  state_ = SessionState::offline;
  outgoing_.clear();
  view_sent_.reset();
  pose_sent_.reset();
  wants_close_ = false;
}

std::vector<Message> LightSession::take_outgoing() { return std::exchange(outgoing_, {}); }

void LightSession::close(GoodbyeReason reason, std::string text) {
  if (state_ != SessionState::offline && !wants_close_) outgoing_.push_back(Goodbye{reason, std::move(text)});
  wants_close_ = true;
}

void LightSession::fail_with(GoodbyeReason reason, std::string text, bool final) {
  end_ = SessionEnd{reason, text, false, final};
  close(reason, std::move(text));
}

Result<bool> LightSession::receive_bytes(FrameClass frame_class, ByteView body, std::uint16_t chunk_edge,
                                         TimeUs received_us) {
  if (frame_class != FrameClass::edits || !is_open() || wants_close_) return false;
  walked_us_ = received_us;
  walked_due_us_.clear();
  walked_own_due_us_.clear();
  const auto walked = walk_.read(body, chunk_edge, on_walked_);
  if (!walked || !*walked) return walked;
  heard_us_ = received_us;
  ++counts_.commits;
  const TimeUs verified_us = clock_now_();
  for (const TimeUs due_us : walked_due_us_) crowd_.see(due_us, verified_us);
  for (const TimeUs due_us : walked_own_due_us_) counts_.own_us.add(verified_us - due_us);
  if (!walked_own_due_us_.empty()) settle_own();
  return true;
}

void LightSession::receive(Message message, const Arrival& arrival) {
  if (state_ == SessionState::offline || wants_close_) return;
  heard_us_ = arrival.now_us;
  std::visit(
      [&](auto& m) {
        using T = std::decay_t<decltype(m)>;
        constexpr bool kAnyTime = std::is_same_v<T, PlayerPoses> || std::is_same_v<T, Roster>;
        if constexpr (std::is_same_v<T, Goodbye>) {
          end_ = SessionEnd{
              m.reason, m.text, true,
              m.reason == GoodbyeReason::wrong_protocol || m.reason == GoodbyeReason::not_authenticated};
          wants_close_ = true;
        } else if constexpr (std::is_same_v<T, Welcome>) {
          if (state_ == SessionState::greeting) return on_welcome(std::move(m));
          fail_with(GoodbyeReason::unexpected_message, "welcome twice", false);
        } else if constexpr (std::is_same_v<T, Ready>) {
          if (state_ == SessionState::proving) return on_ready(m, arrival.now_us);
          fail_with(GoodbyeReason::unexpected_message, "ready out of turn", false);
        } else if constexpr (kAnyTime) {
          // Of others: decoded, and of no use here. They may overtake ready.
          if (state_ == SessionState::greeting)
            fail_with(GoodbyeReason::unexpected_message, "message before ready", false);
        } else if (state_ != SessionState::open) {
          fail_with(GoodbyeReason::unexpected_message, "message before ready", false);
        } else if constexpr (std::is_same_v<T, ChunkSnapshot>) {
          crowd_.ground.add(m.key.at, m.chunk.voxels);
          book_.receive(m, arrival.now_us);
        } else if constexpr (std::is_same_v<T, UniformChunks>) {
          const Extent extent = Extent::cube(welcome_->chunk_edge);
          for (const UniformChunk& chunk : m.chunks) {
            crowd_.ground.add(chunk.key.at, uniform_chunk(extent, chunk.material));
          }
          book_.receive(m, arrival.now_us);
        } else if constexpr (std::is_same_v<T, ChunkUnavailable>) {
          book_.receive(m);
        } else if constexpr (std::is_same_v<T, Audit>) {
          book_.receive(m, arrival.now_us);
        } else if constexpr (std::is_same_v<T, Reject>) {
          on_reject(m);
        } else if constexpr (std::is_same_v<T, Durable>) {
          on_durable(m);
        } else if constexpr (std::is_same_v<T, Pong>) {
          clock_.add(m.sent_us, m.server_us, arrival.received_us);
        } else {
          fail_with(GoodbyeReason::unexpected_message, "message that nobody asked for", false);
        }
      },
      message);
}

void LightSession::on_welcome(Welcome welcome) {
  if (const auto fault = check_welcome(hello_, welcome, config_.pinned)) {
    return fail_with(fault->reason, fault->text, true);
  }
  if (welcome_ && welcome_->world_id != welcome.world_id) {
    own_.clear();
    durable_ = 0;
  }
  if (welcome_ && welcome_->epoch != welcome.epoch) clock_.reset();
  outgoing_.push_back(Proof{sign(config_.keys, client_transcript(hello_, welcome))});
  welcome_ = std::move(welcome);
  state_ = SessionState::proving;
}

void LightSession::on_ready(const Ready& ready, TimeUs now_us) {
  author_ = ready.author;
  ++openings_;
  state_ = SessionState::open;
  ping_us_ = now_us - kPingEveryUs;
  move_us_ = now_us - kMoveEveryUs;
  last_ = 0;
  durable_ = welcome_->durable;
  book_.open(welcome_->epoch);
  if (view_wished_) set_view(*view_wished_);
  own_.resume(ready.decided);
  for (const ClientSequence seq : own_.unanswered()) send(seq, *own_.find(seq));
  settle_own();
  tick(now_us);
}

// ---- while open

void LightSession::tick(TimeUs now_us) {
  if (state_ == SessionState::offline || wants_close_) return;
  if (now_us - heard_us_ > kServerSilenceUsMax) {
    return fail_with(GoodbyeReason::timed_out, "server is silent", false);
  }
  if (!is_open()) return;
  if (now_us - ping_us_ >= kPingEveryUs) {
    outgoing_.push_back(Ping{now_us});
    ping_us_ = now_us;
  }
  if (now_us - move_us_ >= kMoveEveryUs && pose_sent_ != pose_) {
    outgoing_.push_back(Move{pose_});
    pose_sent_ = pose_;
    move_us_ = now_us;
  }
  book_.tick(now_us);
  std::vector<ChunkKey> requests = book_.take_requests();
  for (std::size_t first = 0; first < requests.size(); first += kChunkRequestKeysMax) {
    const std::size_t last = std::min(requests.size(), first + kChunkRequestKeysMax);
    outgoing_.push_back(ChunkRequest{{requests.begin() + static_cast<std::ptrdiff_t>(first),
                                      requests.begin() + static_cast<std::ptrdiff_t>(last)}});
  }
}

TimeUs LightSession::tick_due_us() const {
  if (state_ == SessionState::offline) return std::numeric_limits<TimeUs>::max();
  TimeUs due_us = heard_us_ + kServerSilenceUsMax + 1;
  if (!is_open()) return due_us;
  due_us = std::min(due_us, ping_us_ + kPingEveryUs);
  if (pose_sent_ != pose_) due_us = std::min(due_us, move_us_ + kMoveEveryUs);
  return due_us;
}

Result<ClientSequence> LightSession::submit(const EditDescriptor& edit, TimeUs submitted_us, TimeUs now_us) {
  if (const auto valid = validate(edit); !valid) return Unexpected<Error>{valid.error()};
  if (!welcome_) return fail(ErrorCode::bad_value, "no world is open");
  if (own_.full()) return fail(ErrorCode::limit_exceeded, "too many own edits wait for the server");
  OwnEdit own;
  own.edit = edit;
  own.submitted_us = submitted_us;
  own.sent_us = now_us;
  const ClientSequence seq = own_.add(std::move(own));
  crowd_.due.add(config_.instance, seq, submitted_us);
  if (is_open()) send(seq, *own_.find(seq));
  return seq;
}

void LightSession::send(ClientSequence seq, const OwnEdit& own) {
  outgoing_.push_back(EditRequest{seq, clock_.to_server(own.submitted_us).value_or(0), own.edit});
}

void LightSession::set_view(const View& view) {
  view_wished_ = view;
  if (!is_open()) return;
  const View wished = this->view();
  if (view_sent_ == wished) return;
  book_.set_view(wished);
  outgoing_.push_back(wished);
  view_sent_ = wished;
}

View LightSession::view() const {
  View view = view_wished_.value_or(config_.view);
  const std::uint8_t limit = welcome_ ? welcome_->view_radius_max : std::uint8_t{kViewRadiusMax};
  view.radius_h = std::min(view.radius_h, limit);
  view.radius_v = std::min(view.radius_v, limit);
  return view;
}

bool LightSession::loaded() const {
  return is_open() && view_sent_ && book_.behind() == 0 && book_.known() == chunks_in(view());
}

// ---- edits

Result<void> LightSession::on_edit(const WalkedEdit& edit) {
  if (edit.version.epoch != welcome_->epoch) {
    return fail(ErrorCode::bad_value, "commit of another epoch");
  }
  const Sequence seq = edit.version.seq;
  if (seq <= last_) {
    book_.violations().add("repeated sequence",
                           "edit " + std::to_string(seq) + " came after edit " + std::to_string(last_));
  }
  last_ = std::max(last_, seq);
  ++counts_.edits;
  for (std::size_t i = 0; i < edit.chunks.size(); ++i) {
    book_.follow(edit.chunks[i], edit.ordered.previous[i], seq, walked_us_);
  }
  const OperationId& op = edit.ordered.op;
  if (const auto due_us = crowd_.due.find(op.instance, op.seq)) {
    walked_due_us_.push_back(*due_us);
  } else {
    crowd_.see_unknown();
  }
  if (op.author == author_ && op.instance == config_.instance) on_own_edit(edit);
  return {};
}

void LightSession::on_own_edit(const WalkedEdit& edit) {
  const ClientSequence seq = edit.ordered.op.seq;
  OwnEdit* own = own_.find(seq);
  if (own == nullptr || (own->decided && !own->asked)) {
    book_.violations().add("answer twice", "own edit " + std::to_string(seq) +
                                               " was answered, or never made, and came as edit " +
                                               std::to_string(edit.version.seq));
    return;
  }
  own->decided = true;
  own->asked = own->unseen = false;
  own->version = edit.version;
  ++counts_.own_confirmed;
  walked_own_due_us_.push_back(own->submitted_us);
}

void LightSession::on_reject(const Reject& reject) {
  OwnEdit* own = own_.find(reject.client_seq);
  if (own == nullptr || (own->decided && !own->asked)) {
    // An edit that was offered again may be refused for having been decided, after its commit came all the same.
    if (reject.reason != RejectReason::already_decided) {
      book_.violations().add(
          "answer twice", "own edit " + std::to_string(reject.client_seq) +
                              " was answered, or never made, and is rejected: " + to_string(reject.reason));
    }
    return;
  }
  if (reject.reason == RejectReason::already_decided) {
    own->decided = own->unseen = true;
    own->asked = false;
    own->version = {welcome_->epoch, reject.seq != 0 ? reject.seq : last_};
    return settle_own();
  }
  ++counts_.own_rejected;
  own_.erase(reject.client_seq);
}

void LightSession::on_durable(const Durable& durable) {
  if (durable.epoch != welcome_->epoch || durable.seq < durable_) {
    book_.violations().add("durable", "epoch " + std::to_string(durable.epoch) + " edit " +
                                          std::to_string(durable.seq) + " after edit " +
                                          std::to_string(durable_));
    return;
  }
  durable_ = durable.seq;
  settle_own();
}

void LightSession::settle_own() {
  const OwnEdits::Settled settled = own_.take_durable(durable_);
  counts_.own_durable += settled.durable.size();
  counts_.own_unseen += settled.unseen.size();
}

}  // namespace runstone
