#include "client/bots/headless_session.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "client/replica/view_size.hpp"

namespace runstone {

HeadlessSession::HeadlessSession(SessionConfig config, FleetStatistics& fleet, TimeUs (*clock)())
    : connection_(std::move(config)), crowd_(fleet), clock_now_(clock) {
  on_walked_ = [this](const WalkedEdit& edit) { return on_edit(edit); };
}

// ---- the connection

Result<bool> HeadlessSession::receive_bytes(FrameClass frame_class, ByteView body,
                                            std::uint16_t chunk_edge, TimeUs received_us) {
  if (frame_class != FrameClass::edits || !is_open() || wants_close()) return false;
  walked_us_ = received_us;
  walked_due_us_.clear();
  walked_own_due_us_.clear();
  const auto walked = walk_.read(body, chunk_edge, on_walked_);
  if (!walked || !*walked) return walked;
  connection_.heard(received_us);
  ++counts_.commits;
  const TimeUs verified_us = clock_now_();
  for (const TimeUs due_us : walked_due_us_) crowd_.see(due_us, verified_us);
  for (const TimeUs due_us : walked_own_due_us_) counts_.own_us.add(verified_us - due_us);
  if (!walked_own_due_us_.empty()) settle_own();
  return true;
}

void HeadlessSession::receive(Message message, const Arrival& arrival) {
  switch (connection_.receive(message, arrival)) {
    case ServerConnection::Dispatch::handled:
      return;
    case ServerConnection::Dispatch::another_world:
      own_.clear();
      durable_ = 0;
      return;
    case ServerConnection::Dispatch::ready:
      return on_session_accepted(std::get<SessionAccepted>(message), arrival.now_us);
    case ServerConnection::Dispatch::for_session:
      break;
  }
  std::visit(
      [&](auto& m) {
        using T = std::decay_t<decltype(m)>;
        constexpr bool kAnyTime = std::is_same_v<T, PlayerPoses> || std::is_same_v<T, PlayerList>;
        if constexpr (kAnyTime) {
          // Of others: decoded, and of no use here. They may overtake ready.
          if (connection_.state() == SessionState::greeting)
            connection_.fail_with(GoodbyeReason::unexpected_message, "message before ready");
        } else if (!is_open()) {
          connection_.fail_with(GoodbyeReason::unexpected_message, "message before ready");
        } else if constexpr (std::is_same_v<T, ChunkSnapshot>) {
          crowd_.ground.add(m.key.at, m.chunk.voxels);
          book_.receive(m, arrival.now_us);
        } else if constexpr (std::is_same_v<T, UniformChunks>) {
          const Extent extent = Extent::cube(welcome()->chunk_edge);
          for (const UniformChunk& chunk : m.chunks) {
            crowd_.ground.add(chunk.key.at, uniform_chunk(extent, chunk.material));
          }
          book_.receive(m, arrival.now_us);
        } else if constexpr (std::is_same_v<T, ChunkUnavailable>) {
          book_.receive(m);
        } else if constexpr (std::is_same_v<T, DigestCheck>) {
          book_.receive(m, arrival.now_us);
        } else if constexpr (std::is_same_v<T, Reject>) {
          on_reject(m);
        } else if constexpr (std::is_same_v<T, Durable>) {
          on_durable(m);
        } else {
          connection_.fail_with(GoodbyeReason::unexpected_message, "message that nobody asked for");
        }
      },
      message);
}

void HeadlessSession::on_session_accepted(const SessionAccepted& ready, TimeUs now_us) {
  last_ = 0;
  durable_ = welcome()->durable;
  book_.open(welcome()->epoch);
  if (is_view_wished_) send_view();
  own_.resume(ready.resolved);
  for (const ClientSequence seq : own_.unanswered()) connection_.send_edit(seq, *own_.find(seq));
  settle_own();
  tick(now_us);
}

// ---- while open

void HeadlessSession::tick(TimeUs now_us) {
  if (!connection_.tick(now_us, kPingEveryUs)) return;
  book_.tick(now_us);
  connection_.request_chunks(book_.take_requests());
}

Result<ClientSequence> HeadlessSession::submit(const EditDescriptor& edit, TimeUs submitted_us,
                                               TimeUs now_us) {
  if (const auto valid = validate(edit); !valid) return Unexpected<Error>{valid.error()};
  if (!welcome()) return fail(ErrorCode::bad_value, "no world is open");
  if (own_.full()) return fail(ErrorCode::limit_exceeded, "too many own edits wait for the server");
  OwnEdit own;
  own.edit = edit;
  own.submitted_us = submitted_us;
  own.sent_us = now_us;
  const ClientSequence seq = own_.add(std::move(own));
  crowd_.due.add(connection_.config().instance, seq, submitted_us);
  if (is_open()) connection_.send_edit(seq, *own_.find(seq));
  return seq;
}

void HeadlessSession::set_view(const View& view) {
  is_view_wished_ = true;
  connection_.set_view(view);
  if (is_open()) send_view();
}

void HeadlessSession::send_view() {
  if (connection_.send_view()) book_.set_view(view());
}

bool HeadlessSession::loaded() const {
  return is_open() && connection_.view_was_sent() && book_.behind() == 0 &&
         book_.known() == chunks_in(view());
}

// ---- edits

Result<void> HeadlessSession::on_edit(const WalkedEdit& edit) {
  if (edit.version.epoch != welcome()->epoch) {
    return fail(ErrorCode::bad_value, "commit of another epoch");
  }
  const Sequence seq = edit.version.seq;
  if (seq <= last_) {
    book_.violations().add("repeated sequence", "edit " + std::to_string(seq) +
                                                    " came after edit " + std::to_string(last_));
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
  if (op.author == connection_.author() && op.instance == connection_.config().instance)
    on_own_edit(edit);
  return {};
}

void HeadlessSession::on_own_edit(const WalkedEdit& edit) {
  const ClientSequence seq = edit.ordered.op.seq;
  OwnEdit* own = own_.find(seq);
  if (own == nullptr || (own->resolved && !own->asked)) {
    book_.violations().add("answer twice", "own edit " + std::to_string(seq) +
                                               " was answered, or never made, and came as edit " +
                                               std::to_string(edit.version.seq));
    return;
  }
  own->resolved = true;
  own->asked = own->unseen = false;
  own->version = edit.version;
  ++counts_.own_confirmed;
  walked_own_due_us_.push_back(own->submitted_us);
}

void HeadlessSession::on_reject(const Reject& reject) {
  OwnEdit* own = own_.find(reject.client_seq);
  if (own == nullptr || (own->resolved && !own->asked)) {
    // An edit that was offered again may be refused for having been decided, after its commit came all the same.
    if (reject.reason != RejectReason::already_resolved) {
      book_.violations().add("answer twice", "own edit " + std::to_string(reject.client_seq) +
                                                 " was answered, or never made, and is rejected: " +
                                                 to_string(reject.reason));
    }
    return;
  }
  if (reject.reason == RejectReason::already_resolved) {
    own->resolved = own->unseen = true;
    own->asked = false;
    own->version = {welcome()->epoch, reject.seq != 0 ? reject.seq : last_};
    return settle_own();
  }
  ++counts_.own_rejected;
  own_.erase(reject.client_seq);
}

void HeadlessSession::on_durable(const Durable& durable) {
  if (durable.epoch != welcome()->epoch || durable.seq < durable_) {
    book_.violations().add("durable", "epoch " + std::to_string(durable.epoch) + " edit " +
                                          std::to_string(durable.seq) + " after edit " +
                                          std::to_string(durable_));
    return;
  }
  durable_ = durable.seq;
  settle_own();
}

void HeadlessSession::settle_own() {
  const LocalEdits::Settled settled = own_.take_durable(durable_);
  counts_.own_durable += settled.durable.size();
  counts_.own_unseen += settled.unseen.size();
}

}  // namespace runstone
