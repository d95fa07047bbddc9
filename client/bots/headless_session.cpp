#include "client/bots/headless_session.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "protocol/codec/message_table.hpp"
#include "protocol/codec/view_size.hpp"

namespace runstone {

namespace {

/// Returns the configuration without what only a player needs.
SessionConfig for_bot(SessionConfig config) {
  config.features &= ~(kFeatureRights | kFeatureChat | kFeatureChatWithdrawal | kFeaturePreviews |
                       kFeatureTextures | kFeatureWorldTime | kFeatureVisits | kFeatureStrokes);
  return config;
}

}  // namespace

HeadlessSession::HeadlessSession(SessionConfig config, FleetStatistics& fleet, TimeUs (*clock)())
    : connection_(for_bot(std::move(config))), fleet_(fleet), clock_now_(clock) {
  on_walked_ = [this](const WalkedEdit& edit) { return on_edit(edit); };
}

// Connection.

Result<bool> HeadlessSession::receive_bytes(MessageKind kind, ByteView body,
                                            std::uint16_t chunk_edge, TimeUs received_us) {
  if (kind != kKindOf<Commit> || !is_open() || wants_close()) return false;
  walked_us_ = received_us;
  walked_due_us_.clear();
  walked_local_due_us_.clear();
  const auto walked = walk_.read(body, chunk_edge, on_walked_);
  if (!walked) return failure(walked.error());
  connection_.note_message(received_us);
  ++counts_.commits;
  const TimeUs verified_us = clock_now_();
  for (const TimeUs due_us : walked_due_us_) fleet_.see(due_us, verified_us);
  for (const TimeUs due_us : walked_local_due_us_) counts_.confirm_us.add(verified_us - due_us);
  if (!walked_local_due_us_.empty()) local_edits_.retire(durable_);
  return true;
}

void HeadlessSession::receive(Message message, const Arrival& arrival) {
  switch (connection_.receive(message, arrival)) {
    case ServerConnection::Dispatch::handled:
      return;
    case ServerConnection::Dispatch::another_world:
      local_edits_.clear();
      durable_ = 0;
      return;
    case ServerConnection::Dispatch::session_accepted:
      return on_session_accepted(std::get<SessionAccepted>(message), arrival.now_us);
    case ServerConnection::Dispatch::materials_added:
      return;
    case ServerConnection::Dispatch::for_session:
      break;
  }
  std::visit(
      [&](auto& m) {
        using T = std::decay_t<decltype(m)>;
        constexpr bool kAnyTime = std::is_same_v<T, PlayerPoses> || std::is_same_v<T, PlayerList>;
        if constexpr (kAnyTime) {
          // Decoded, but not used. These may overtake SessionAccepted.
          if (connection_.state() == SessionState::hello_sent)
            connection_.fail_with(GoodbyeReason::unexpected_message, "message before ready");
        } else if (!is_open()) {
          connection_.fail_with(GoodbyeReason::unexpected_message, "message before ready");
        } else if constexpr (std::is_same_v<T, Chunks>) {
          on_chunks(m, arrival.now_us);
        } else if constexpr (std::is_same_v<T, UniformChunks>) {
          on_uniform_chunks(m, arrival.now_us);
        } else if constexpr (std::is_same_v<T, ViewState>) {
          on_view_state(m);
        } else if constexpr (std::is_same_v<T, ChunkUnavailable>) {
          versions_.receive(m);
        } else if constexpr (std::is_same_v<T, DigestCheck>) {
          versions_.receive(m, arrival.now_us);
        } else if constexpr (std::is_same_v<T, Reject>) {
          on_reject(m);
        } else if constexpr (std::is_same_v<T, Resume>) {
          on_resume(m);
        } else if constexpr (std::is_same_v<T, Durable>) {
          on_durable(m);
        } else {
          fail_unrequested();
        }
      },
      message);
}

void HeadlessSession::fail_unrequested() {
  connection_.fail_with(GoodbyeReason::unexpected_message, "message that was not requested");
}

void HeadlessSession::on_chunks(const Chunks& chunks, TimeUs now_us) {
  for (const ChunkAnswer& answer : chunks.chunks) {
    if (const auto* snapshot = std::get_if<ChunkSnapshot>(&answer))
      fleet_.ground.add(snapshot->key.at, snapshot->chunk.voxels);
  }
  versions_.receive(chunks, now_us);
}

void HeadlessSession::on_uniform_chunks(const UniformChunks& uniform, TimeUs now_us) {
  const Extent extent = Extent::cube(welcome()->chunk_edge);
  for (const UniformChunk& chunk : uniform.chunks) {
    fleet_.ground.add(chunk.key.at, uniform_chunk(extent, chunk.material));
  }
  versions_.receive(uniform, now_us);
}

void HeadlessSession::on_view_state(const ViewState& state) {
  // This session sends no history requests.
  if (state.phase != ViewPhase::complete || state.request != 0 || state.past) {
    return fail_unrequested();
  }
  versions_.complete(state.view);
}

void HeadlessSession::on_session_accepted(const SessionAccepted& accepted, TimeUs now_us) {
  last_ = 0;
  durable_ = welcome()->durable;
  versions_.open(welcome()->epoch, CoordLimit::of(welcome()->chunk_edge));
  if (has_view_) send_view();
  local_edits_.resume(accepted.resolved);
  for (const ClientSequence seq : local_edits_.unanswered()) {
    connection_.send_edit(seq, *local_edits_.find(seq));
  }
  local_edits_.retire(durable_);
  tick(now_us);
}

void HeadlessSession::on_resume(const Resume& resume) {
  connection_.send(Resumed{});
  local_edits_.resume(resume.resolved);
  for (const ClientSequence seq : local_edits_.unanswered())
    connection_.send_edit(seq, *local_edits_.find(seq));
}

// While open.

void HeadlessSession::tick(TimeUs now_us) {
  if (!connection_.tick(now_us, kPingEveryUs)) return;
  versions_.tick(now_us);
  connection_.request_chunks(versions_.take_requests());
}

Result<ClientSequence> HeadlessSession::offer(const EditDescriptor& edit, TimeUs submitted_us,
                                              TimeUs now_us) {
  if (const auto valid = validate(edit); !valid) return failure(valid.error());
  if (!welcome()) return fail(ErrorCode::bad_value, "no world is open");
  const auto seq = local_edits_.add(edit, {}, submitted_us);
  if (!seq) return seq;
  local_edits_.mark_sent(*seq, now_us);
  fleet_.due.add(connection_.config().instance, *seq, submitted_us);
  if (is_open()) connection_.send_edit(*seq, *local_edits_.find(*seq));
  return seq;
}

void HeadlessSession::set_view(const View& view) {
  has_view_ = true;
  connection_.set_view(view);
  if (is_open()) send_view();
}

void HeadlessSession::send_view() {
  if (connection_.send_view()) versions_.set_view(view());
}

bool HeadlessSession::loaded() const {
  const bool is_near_loaded =
      is_open() && connection_.view_was_sent() && versions_.behind() == 0 &&
      versions_.known() == chunks_in(view(), CoordLimit::of(welcome()->chunk_edge));
  if (!is_near_loaded) return false;
  const bool has_tiles = (welcome()->features & kFeatureTiles) != 0 && tile_levels(view()) != 0;
  return !has_tiles || versions_.tiles_are_complete();
}

// Edits.

Result<void> HeadlessSession::on_edit(const WalkedEdit& edit) {
  if (edit.version.epoch != welcome()->epoch) {
    return fail(ErrorCode::bad_value, "commit of another epoch");
  }
  const Sequence seq = edit.version.seq;
  if (seq <= last_) {
    versions_.violations().add(
        "repeated sequence",
        "edit " + std::to_string(seq) + " came after edit " + std::to_string(last_));
  }
  last_ = std::max(last_, seq);
  ++counts_.edits;
  for (std::size_t i = 0; i < edit.chunks.size(); ++i) {
    versions_.follow(edit.chunks[i], edit.ordered.previous[i], seq, walked_us_);
  }
  const OperationId& op = edit.ordered.op;
  if (const auto due_us = fleet_.due.find(op.instance, op.seq)) {
    walked_due_us_.push_back(*due_us);
  } else {
    fleet_.see_unknown();
  }
  if (op.author == connection_.author() && op.instance == connection_.config().instance)
    on_local_edit(edit);
  return {};
}

void HeadlessSession::on_local_edit(const WalkedEdit& edit) {
  const ClientSequence seq = edit.ordered.op.seq;
  const auto before = local_edits_.confirm(seq, edit.version);
  if (before == LocalEditState::pending || before == LocalEditState::asking) {
    walked_local_due_us_.push_back(local_edits_.find(seq)->submitted_us);
    return;
  }
  versions_.violations().add("answer twice", "local edit " + std::to_string(seq) +
                                                 " waits for no answer, and was ordered as edit " +
                                                 std::to_string(edit.version.seq));
}

void HeadlessSession::on_reject(const Reject& reject) {
  if (const auto rejection = local_edits_.reject(reject, {welcome()->epoch, last_})) {
    if (rejection->is_resolved) local_edits_.retire(durable_);
    return;
  }
  // The commit of an edit that was offered again may arrive before the reject that says it is
  // resolved already.
  if (reject.reason == RejectReason::already_resolved) return;
  versions_.violations().add(
      "answer twice", "local edit " + std::to_string(reject.client_seq) +
                          " waits for no answer, and is rejected: " + to_string(reject.reason));
}

void HeadlessSession::on_durable(const Durable& durable) {
  if (durable.epoch != welcome()->epoch || durable.seq < durable_) {
    versions_.violations().add("durable", "epoch " + std::to_string(durable.epoch) + " edit " +
                                              std::to_string(durable.seq) + " after edit " +
                                              std::to_string(durable_));
    return;
  }
  durable_ = durable.seq;
  versions_.raise_epoch(durable.epoch);
  local_edits_.retire(durable_);
}

}  // namespace runstone
