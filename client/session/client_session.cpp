#include "client/session/client_session.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "common/core/assert.hpp"
#include "common/core/text.hpp"
#include "protocol/codec/view_size.hpp"
#include "protocol/codec/view_tiles.hpp"
#include "protocol/rules/chat_text.hpp"
#include "protocol/rules/window_bytes.hpp"

namespace runstone {
namespace {

constexpr std::size_t kOldWindowEdits = 16;

}  // namespace

ClientSession::ClientSession(SessionConfig config) : connection_(std::move(config)) {
  if (connection_.config().has_cache) replica_->collect_for_cache();
}

// Connection.

void ClientSession::connected(const Nonce& nonce, const std::optional<ChannelBinding>& binding,
                              TimeUs now_us, bool is_listed) {
  disconnected();
  connection_.connected(nonce, binding, now_us, is_listed);
}

void ClientSession::disconnected() {
  connection_.disconnected();
  waiting_.clear();
  view_waiting_since_us_.reset();
  looked_up_.clear();
  lookup_keys_.clear();
  lookups_stale_ += std::exchange(lookups_open_, 0);
  if (!others_.empty()) ++players_serial_;
  others_.clear();
  previews_.reset();
  history_.clear();
  timeline_.disconnected();
  voxel_author_.disconnected();
  library_.disconnected();
  textures_.disconnected();
  chat_.disconnected();
  if (is_commanding_) {
    command_lines_ = {"the connection ended before the answer came"};
    is_answer_lost_ = true;
  }
  is_commanding_ = false;
  restore_preview_.reset();  // the server forgets its previews when it ends
  early_.clear();
}

void ClientSession::receive(Message message, const Arrival& arrival) {
  if (connection_.accepts_input()) now_us_ = arrival.now_us;
  switch (connection_.receive(message, arrival)) {
    case ServerConnection::Dispatch::handled:
      return;
    case ServerConnection::Dispatch::another_world:
      lost_.clear();
      chat_.clear();
      timeline_.clear();
      voxel_author_.clear();
      library_.clear();
      textures_.clear();
      return replica_->reset();
    case ServerConnection::Dispatch::session_accepted:
      return on_session_accepted(std::get<SessionAccepted>(message), arrival.now_us);
    case ServerConnection::Dispatch::materials_added:
      if (std::holds_alternative<ShapesGiven>(message)) replica_->end_tile_rules();
      return replica_->set_material_count(welcome()->materials.size());
    case ServerConnection::Dispatch::for_session:
      break;
  }
  std::visit(
      [&](auto& m) {
        using T = std::decay_t<decltype(m)>;
        if (state() == SessionState::authenticating && !std::is_same_v<T, Chunks> &&
            early_.size() < kEarlyMessagesMax) {
          early_.emplace_back(std::move(m), arrival);
        } else if (!is_open()) {
          connection_.fail_with(GoodbyeReason::unexpected_message, "message before ready");
        } else if constexpr (std::is_same_v<T, Chunks>) {
          replica_->receive(std::move(m), arrival);
        } else if constexpr (std::is_same_v<T, ChunksNotModified>) {
          replica_->receive(m, arrival.now_us);
        } else if constexpr (std::is_same_v<T, UniformChunks>) {
          replica_->receive(m, arrival);
        } else if constexpr (std::is_same_v<T, ChunkUnavailable>) {
          replica_->receive(m);
        } else if constexpr (std::is_same_v<T, Commit> || std::is_same_v<T, VeiledCommit> ||
                             std::is_same_v<T, VeilPatches>) {
          const auto taken = replica_->receive(m, arrival);
          if (!taken) connection_.fail_with(GoodbyeReason::malformed_message, taken.error().what);
          if constexpr (std::is_same_v<T, Commit>) {
            for (const OrderedEdit& edit : m.edits) previews_.forget_stroke(edit.op.author);
          } else if constexpr (std::is_same_v<T, VeiledCommit>) {
            for (const VeiledEdit& edit : m.edits) previews_.forget_stroke(edit.ordered.op.author);
          }
        } else if constexpr (std::is_same_v<T, Reject>) {
          if (m.reason == RejectReason::rate_limited) allowance_.refused(arrival.now_us);
          const bool is_kept = lost_.take(replica_->local_edits(), m, opened_us_, arrival.now_us);
          replica_->receive(m, arrival.now_us, is_kept);
        } else if constexpr (std::is_same_v<T, DigestCheck>) {
          replica_->receive(m, arrival.now_us);
        } else if constexpr (std::is_same_v<T, Permissions>) {
          allowance_.set(m.edit_budget, welcome()->chunk_edge);
          replica_->receive(m);
        } else if constexpr (std::is_same_v<T, ProtectedGround>) {
          const auto taken = replica_->receive(m);
          if (!taken) connection_.fail_with(GoodbyeReason::malformed_message, taken.error().what);
        } else if constexpr (std::is_same_v<T, Durable>) {
          is_server_read_only_ = m.is_read_only;
          replica_->receive(m);
        } else if constexpr (std::is_same_v<T, Resume>) {
          connection_.send(Resumed{});
          waiting_ = replica_->resume(m.resolved);
        } else if constexpr (std::is_same_v<T, ViewState>) {
          on_view_state(m);
        } else if constexpr (std::is_same_v<T, PlayerPoses>) {
          on_poses(m);
        } else if constexpr (std::is_same_v<T, PlayerList>) {
          on_player_list(m);
        } else if constexpr (std::is_same_v<T, CommandOutput>) {
          on_command_output(std::move(m));
        } else if constexpr (std::is_same_v<T, LogMarks>) {
          if (!voxel_author_.receive(m) && timeline_.receive(m, arrival.now_us)) ++timeline_serial_;
        } else if constexpr (std::is_same_v<T, Builds> || std::is_same_v<T, BuildPiece>) {
          library_.receive(std::move(m), arrival.now_us);
        } else if constexpr (std::is_same_v<T, BuildAnswer>) {
          library_.receive(m, arrival.now_us);
        } else if constexpr (std::is_same_v<T, TexturesGiven>) {
          const auto taken = textures_.receive(m);
          if (!taken) connection_.fail_with(GoodbyeReason::malformed_message, taken.error().what);
        } else if constexpr (std::is_same_v<T, TextureParts>) {
          textures_.receive(std::move(m));
        } else if constexpr (std::is_same_v<T, RestorePreview>) {
          on_restore_preview(std::move(m));
        } else if constexpr (std::is_same_v<T, ChatLines>) {
          chat_.receive(std::move(m));
        } else if constexpr (std::is_same_v<T, ChatWithdrawn>) {
          chat_.receive(m);
        } else if constexpr (std::is_same_v<T, PlayerPreview>) {
          if (m.author != author())
            previews_.receive(std::move(m), welcome()->chunk_edge, arrival.now_us);
        } else {
          connection_.fail_with(GoodbyeReason::unexpected_message, "message of a client");
        }
      },
      message);
}

void ClientSession::on_session_accepted(const SessionAccepted& accepted, TimeUs now_us) {
  const Welcome& world = *welcome();
  opened_us_ = now_us;
  tile_rules_ = accepted.tile_rules;
  is_server_read_only_ = false;
  allowance_.set(world.edit_budget, world.chunk_edge);
  allowance_.set_clipboard_bytes((world.features & kFeatureLargeActions) != 0
                                     ? EditPrices::kClipboardBytes
                                     : EditPrices::kClipboardBytesBefore);
  textures_.connected((world.features & kFeatureTextures) != 0, connection_.config().has_cache);
  replica_->set_view(view());
  waiting_ = replica_->open({.chunk_edge = world.chunk_edge,
                             .author = accepted.author,
                             .instance = connection_.config().instance,
                             .epoch = world.epoch,
                             .durable = world.durable,
                             .head = world.head,
                             .resolved = accepted.resolved,
                             .tile_rules = accepted.tile_rules,
                             .is_veiled = (world.features & kFeatureVeil) != 0,
                             .heights = world.heights,
                             .edit_volume_max = world.edit_volume_max,
                             .material_count = world.materials.size()});
  refresh_view();
  tick(now_us);
  for (auto& [message, arrival] : std::exchange(early_, {})) receive(std::move(message), arrival);
}

// While open.

void ClientSession::tick(TimeUs now_us) {
  const bool is_offset_wanted = pongs() < kPingsFirst || !clock().known();
  if (!connection_.tick(now_us, is_offset_wanted ? kPingEveryFirstUs : kPingEveryUs)) return;
  now_us_ = now_us;
  const TimeUs cache_wait_us = connection_.config().cache_wait_us;
  if (view_waiting_since_us_ && now_us - *view_waiting_since_us_ >= cache_wait_us) send_view();
  replica_->tick(now_us);
  previews_.expire(now_us);
  connection_.request_chunks(replica_->take_requests());
  for (Message& message : textures_.step()) connection_.send(std::move(message));
  offer_lost_edits(now_us);
  send_waiting_edits(now_us);
}

void ClientSession::offer_lost_edits(TimeUs now_us) {
  lost_.forget_settled(replica_->local_edits());
  while (const LostEdit* lost = lost_.due(now_us)) {
    InAction in_action = lost_.action();
    in_action.again_of = lost->seq;
    const auto offered = offer(lost->edit, lost->submitted_us, now_us, in_action);
    const bool is_later = !offered && offered.error().code == ErrorCode::limit_exceeded;
    if (is_later) return lost_.put_off(now_us);
    if (offered) {
      lost_.offered(*offered);
    } else {
      lost_.drop();
    }
  }
}

Result<ClientSequence> ClientSession::offer(const EditDescriptor& edit, TimeUs submitted_us,
                                            TimeUs now_us, InAction in_action) {
  // The edit is paid only once the replica has checked it.
  if (validate(edit) && allowance_.wait_us(edit, now_us) > 0)
    return fail(ErrorCode::limit_exceeded, "your edit budget is used up for now");
  const auto seq = replica_->predict(edit, submitted_us, now_us, in_action);
  if (seq) allowance_.pay(edit, now_us);
  if (seq && is_open()) {
    waiting_.push_back(*seq);
    send_waiting_edits(now_us);
  }
  return seq;
}

std::string ClientSession::refusal_text(const EditDescriptor& edit, const Error& error) const {
  if (error.code == ErrorCode::not_permitted) {
    if (auto why = replica_->ground().refusal(edit)) return *std::move(why);
  }
  if (replica_->opened() && validate(edit)) {
    const EditLimits limits = replica_->edit_limits();
    if (const auto wrong = check_edit(edit, limits)) {
      if (std::string words = refusal_words(*wrong, edit, limits); !words.empty()) return words;
    }
  }
  return error.what;
}

void ClientSession::send_waiting_edits(TimeUs now_us) {
  // The answer to an overdue edit was lost. The server knows by the operation id whether it has
  // resolved the edit, so sending it again is harmless.
  if (waiting_.empty()) waiting_ = replica_->local_edits().overdue(now_us - kAnswerUsMax);
  if (waiting_.empty()) return;
  // Without a clock offset the other clients could not tell how old the edit is.
  if (!clock().known() && now_us - opened_us_ < kOffsetWaitUsMax) return;
  std::size_t done = 0;
  for (; done < waiting_.size(); ++done) {
    const ClientSequence seq = waiting_[done];
    const LocalEdit* local = replica_->local_edits().find(seq);
    if (local == nullptr || !local->needs_answer()) continue;
    const bool is_counted = local->sent_us == LocalEdit::kNever;
    // The edits behind it keep their order: the server takes ascending client sequences.
    if (is_counted && has_large_actions() && !fits_window(local->edit)) break;
    connection_.send_edit(seq, *local);
    replica_->mark_sent(seq, now_us);
  }
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(done));
}

bool ClientSession::has_large_actions() const {
  return is_open() && (welcome()->features & kFeatureLargeActions) != 0;
}

bool ClientSession::fits_window(const EditDescriptor& edit) const {
  const LocalEdits::UnderWay& under_way = replica_->local_edits().under_way();
  return under_way.edits < welcome()->waiting_edits_max &&
         under_way.bytes + window_bytes(edit) <= welcome()->waiting_edit_bytes_max;
}

bool ClientSession::has_window_for(const EditDescriptor& edit) const {
  if (!is_open() || !waiting_.empty()) return false;
  if (replica_->local_edits().all().size() >= kLocalEditsMax / 2) return false;
  if (has_large_actions()) return fits_window(edit);
  // A server without large actions has no window. A few edits keep it busy.
  return replica_->local_edits().under_way().edits < kOldWindowEdits;
}

void ClientSession::set_view(const View& view) {
  // The replica has forgotten the chunks outside of a view that waits. The server must forget them
  // too, or it would not send those of them again that the new view contains.
  const bool is_moved = !connection_.config().view.same_chunks(view);
  if (is_moved && view_waiting_since_us_ && connection_.view_was_sent()) send_view();
  connection_.set_view(view);
  const View allowed = this->view();
  if (!replica_->view() || !replica_->view()->same_chunks(allowed)) replica_->set_view(allowed);
  if (is_open()) refresh_view();
}

Result<void> ClientSession::command(std::string text) {
  if (!is_open()) return fail(ErrorCode::bad_value, "no world is open");
  if ((welcome()->features & kFeatureCommands) == 0) {
    return fail(ErrorCode::unknown_kind, "the server takes no commands");
  }
  if (is_commanding_) return fail(ErrorCode::bad_value, "the previous command is still running");
  if (text.empty() || text.size() > kCommandBytesMax || !is_printable_utf8(text)) {
    return fail(ErrorCode::bad_value, "a command is 1 to 1024 bytes of text");
  }
  is_commanding_ = true;
  is_command_ok_ = is_answer_lost_ = false;
  command_lines_.clear();
  restore_preview_.reset();
  connection_.send(CommandRequest{++command_, std::move(text)});
  return {};
}

Result<void, std::string> ClientSession::chat(std::string_view line) {
  if (!is_open()) return failure("no world is open");
  if ((welcome()->features & kFeatureChat) == 0) return failure("the server has no chat");
  auto text = chat_text(line);
  if (!text) return failure(text.error());
  connection_.send(ChatRequest{*std::move(text)});
  return {};
}

void ClientSession::share_preview(const std::vector<EditDescriptor>& edits, TimeUs now_us,
                                  const std::optional<BrushStroke>& stroke) {
  if (!is_open() || (welcome()->features & kFeaturePreviews) == 0) return;
  const bool takes_strokes = (welcome()->features & kFeatureStrokes) != 0;
  if (auto share = previews_.share(edits, welcome()->chunk_edge, now_us,
                                   takes_strokes ? stroke : std::nullopt))
    connection_.send(*std::move(share));
}

void ClientSession::on_command_output(CommandOutput output) {
  // A lost connection ended the command of any other id.
  if (!is_commanding_ || output.id != command_) return;
  for (std::string& line : output.lines) {
    if (command_lines_.size() < kCommandLinesKept) command_lines_.push_back(std::move(line));
  }
  is_commanding_ = !output.is_done;
  is_command_ok_ = output.is_done && output.is_ok;
}

void ClientSession::on_restore_preview(RestorePreview preview) {
  if (!is_commanding_ || preview.command != command_) return;
  const std::size_t materials = welcome()->materials.size();
  // The server makes the edits of a preview chunk by chunk.
  constexpr std::uint64_t kChunksMax = 8;
  std::erase_if(preview.edits, [&](const EditDescriptor& edit) {
    return material_max(edit) >= materials ||
           touched_chunks_bound(edit, welcome()->chunk_edge) > kChunksMax;
  });
  restore_preview_ = std::move(preview);
}

void ClientSession::step_timeline(TimeUs now_us) {
  if (!is_open()) return;
  if ((welcome()->features & kFeatureLogMarks) == 0)
    return timeline_.refuse("this server does not say who edited");
  // A later request would replace one that the server has not answered.
  if (voxel_author_.is_waiting()) return;
  // The server reads marks from its disk, so it has none of the edits that are not durable.
  const Sequence newest = replica_->durable();
  const auto& past = replica_->past();
  if (const auto request = timeline_.next_request(newest, past ? past->seq : newest, now_us))
    connection_.send(*request);
}

void ClientSession::step_voxel_author(const std::optional<VoxelPos>& at, TimeUs now_us) {
  const bool is_known =
      is_open() && (welcome()->features & kFeatureVoxelAuthors) != 0 && !replica_->past();
  std::optional<VoxelAuthor::Sight> sight;
  if (at && is_known) {
    const std::int32_t edge = replica_->chunk_edge();
    const ChunkPtr chunk = replica_->confirmed({0, chunk_of(*at, edge)});
    // The server reads its disk, which lacks edits that are not durable.
    if (chunk != nullptr && chunk->version.seq <= replica_->durable()) {
      const Material material = material_at(chunk->voxels, local_of(*at, edge));
      if (replica_->shown_at(*at) == material) sight = {*at, material, chunk->version};
    }
  }
  if (const auto request = voxel_author_.look(sight, !timeline_.is_waiting(), now_us))
    connection_.send(*request);
}

bool ClientSession::has_library() const {
  return is_open() && (welcome()->features & kFeatureBuilds) != 0;
}

void ClientSession::step_library(TimeUs now_us) {
  if (!library_.is_busy()) return;
  if (!is_open()) return library_.refuse("no world is open");
  if (!has_library()) return library_.refuse("this server gives clients no library of builds");
  for (Message& message : library_.step(now_us)) connection_.send(std::move(message));
}

Result<void> ClientSession::request_history(const HistoryRequest& request) {
  if (!is_open()) return fail(ErrorCode::bad_value, "no world is open");
  connection_.send(history_.next(request));
  return {};
}

void ClientSession::on_view_state(const ViewState& state) {
  if (state.phase == ViewPhase::begins) {
    replica_->show_moment(state.past ? std::optional(PastMoment{state.seq, state.utc_us})
                                     : std::nullopt);
  }
  history_.receive(state);
}

void ClientSession::refresh_view() {
  if (connection_.config().has_cache) {
    std::erase_if(looked_up_, [v = view()](const ChunkKey& key) { return !contains_key(v, key); });
    const auto look_up = [this](const ChunkKey& key) {
      if (looked_up_.insert(key).second) lookup_keys_.push_back(key);
    };
    for (const ChunkKey& key : replica_->missing()) look_up(key);
    for (const ChunkKey& key : replica_->take_missing_tiles()) look_up(key);
  }
  if (lookup_keys_.empty() && lookups_open_ == 0) return send_view();
  if (!view_waiting_since_us_) view_waiting_since_us_ = now_us_;
}

std::optional<CacheLookup> ClientSession::take_cache_lookup() {
  const auto world = cached_world();
  if (!world || lookup_keys_.empty()) return std::nullopt;
  ++lookups_open_;
  std::sort(lookup_keys_.begin(), lookup_keys_.end());
  return CacheLookup{*world, std::exchange(lookup_keys_, {})};
}

void ClientSession::receive_cache_result(std::vector<KeyedChunk> found, TimeUs now_us) {
  if (lookups_stale_ != 0) {
    // The lookup was made for an earlier connection: another server may be there now.
    --lookups_stale_;
    return;
  }
  RUNSTONE_ASSERT(lookups_open_ != 0);
  --lookups_open_;
  now_us_ = now_us;
  for (auto& [key, chunk] : found) replica_->adopt(key, std::move(chunk), now_us);
  if (lookups_open_ == 0 && lookup_keys_.empty()) send_view();
}

std::optional<CachedWorld> ClientSession::cached_world() const {
  if (!is_open()) return std::nullopt;
  return CachedWorld{welcome()->world_id,
                     welcome()->chunk_edge,
                     {welcome()->epoch, replica_->durable(), replica_->newest()},
                     tile_rules_};
}

void ClientSession::send_view() {
  view_waiting_since_us_.reset();
  for (Message& held : cached_chunks_messages(replica_->take_claims()))
    connection_.send(std::move(held));
  connection_.send_view();
}

std::size_t ClientSession::view_chunks() const {
  return chunks_in(view(), CoordLimit::of(welcome()->chunk_edge));
}

bool ClientSession::loaded() const {
  return is_open() && !history_.is_loading() &&
         replica_->current_count() + replica_->unavailable_count() == view_chunks() &&
         replica_->awaiting_count() == 0;
}

void ClientSession::on_player_list(const PlayerList& list) {
  ++players_serial_;
  std::map<AuthorId, OtherPlayer> known = std::exchange(others_, {});
  if (list.is_change) std::swap(known, others_);
  for (const AuthorId author : list.left) {
    others_.erase(author);
    previews_.forget(author);
  }
  for (const PlayerName& player : list.players) {
    if (player.author == author()) continue;
    OtherPlayer& other = others_[player.author];
    other.name = player.name;
    other.key = player.key;
    other.role = player.role;
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
