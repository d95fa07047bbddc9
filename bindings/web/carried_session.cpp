#include "bindings/web/carried_session.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "client/replica/ray_pick.hpp"
#include "client/session/failure_words.hpp"
#include "common/materials/material_table.hpp"
#include "protocol/codec/frame_bytes.hpp"

namespace runstone {
namespace {

/// The bytes that the stream writes at a time, about. A small number lets edits soon pass other
/// messages.
constexpr std::size_t kWriteBytes = std::size_t{64} << 10;

SessionConfig session_config_of(const CarriedPlayer& player) {
  SessionConfig config;
  config.keys = key_pair_of(player.seed);
  config.name = player.name;
  config.ticket = player.ticket;
  config.instance = player.instance;
  config.view.radius_h = std::min(player.radius_h, kCarriedRadiusMax);
  config.view.radius_v = std::min(player.radius_v, kCarriedRadiusMax);
  return config;
}

/// The session is pure, so it does not measure the time of unpacking.
std::int64_t no_clock_ns() { return 0; }

MeshMaterials materials_as_cubes(const MaterialTable& table) {
  return MeshMaterials(VisibilityTable(half_filled_visibilities(table)));
}

std::string words_of_reject(const RejectedEdit& reject) {
  return reject.detail.empty() ? "the server rejected the edit" : reject.detail;
}

}  // namespace

CarriedSession::CarriedSession(const CarriedPlayer& player)
    : session_(session_config_of(player)), view_(session_config_of(player).view) {}

void CarriedSession::connected(const Nonce& nonce, TimeUs now_us) {
  if (stream_) disconnected();
  now_us_ = now_us;
  stream_ = std::make_unique<MessageStream>(++connection_, stats_, static_cast<MessageSink&>(*this),
                                            no_clock_ns);
  session_.connected(nonce, std::nullopt, now_us);
  queue_outgoing();
}

Result<void> CarriedSession::receive(ByteView bytes, TimeUs now_us) {
  if (!stream_) return fail(ErrorCode::bad_value, "there is no connection");
  now_us_ = now_us;
  const auto taken = stream_->receive(bytes, now_us);
  queue_outgoing();
  return taken;
}

void CarriedSession::on_received(LinkReceived received) {
  session_.receive(std::move(received.message), {now_us_, now_us_, now_us_});
  if (std::exchange(opened_, session_.connect_count()) == session_.connect_count()) return;
  const Welcome& welcome = *session_.welcome();
  if (world_ && *world_ != welcome.world_id) {
    material_count_ = 0;
    moved_to_.reset();
    waiting_again_.clear();
    numbers_.clear();
  }
  world_ = welcome.world_id;
  update_materials();
  if (moved_to_) {
    centre_view(*moved_to_);
  } else {
    const auto& place = session_.place();
    move(place ? place->at : welcome.spawn, 0, 0);
    moved_to_.reset();
  }
  note(CarriedNoticeKind::opened, 0, "");
}

void CarriedSession::disconnected() {
  if (!stream_) return;
  stream_.reset();
  frames_.clear();
  frames_taken_ = 0;
  is_overfull_ = false;
  session_.disconnected();
  std::string text = "the connection was lost";
  if (const auto& end = session_.end()) {
    const FailureWords words = words_of(*end);
    text = words.detail.empty() ? words.headline : words.headline + ": " + words.detail;
  }
  note(session_.end() && session_.end()->final ? CarriedNoticeKind::refused
                                               : CarriedNoticeKind::closed,
       0, std::move(text));
}

void CarriedSession::step(TimeUs now_us) {
  now_us_ = now_us;
  session_.tick(now_us);
  if (stream_) static_cast<void>(stream_->acknowledge(now_us));
  queue_outgoing();
  if (session_.is_open()) update_materials();
  take_changes();
}

void CarriedSession::update_materials() {
  const MaterialTable& table = session_.welcome()->materials;
  if (table.size() == material_count_ && session_.shapes_number() == shapes_number_) return;
  shapes_number_ = session_.shapes_number();
  material_count_ = table.size();
  materials_ = materials_as_cubes(table);
  planner_.forget_meshes();
  note(CarriedNoticeKind::materials, static_cast<std::uint32_t>(material_count_), "");
}

void CarriedSession::queue_outgoing() {
  for (const Message& message : session_.take_outgoing()) {
    if (stream_ && !stream_->queue(encode_message(message))) is_overfull_ = true;
  }
}

void CarriedSession::take_changes() {
  const ReplicaChanges changes = session_.replica().drain_changes();
  planner_.take(changes.chunks);
  for (const ChunkChange& change : changes.chunks) {
    if (change.removed && drawn_.erase(change.key) != 0) gone_.push_back(change.key);
  }
  note_outcomes(changes);
  note_command_end();
  for (const ChatLine& line : session_.drain_chat())
    note(CarriedNoticeKind::chat, 0, line.name.empty() ? line.text : line.name + ": " + line.text);
}

ClientSequence CarriedSession::number_of(ClientSequence seq) const {
  const auto found = numbers_.find(seq);
  return found == numbers_.end() ? seq : found->second;
}

void CarriedSession::note_outcomes(const ReplicaChanges& changes) {
  const auto end = [&](CarriedNoticeKind kind, ClientSequence seq, std::string text) {
    note(kind, static_cast<std::uint32_t>(number_of(seq)), std::move(text));
    numbers_.erase(seq);
  };
  for (const RejectedEdit& reject : changes.rejects) {
    if (reject.is_offered_again) {
      waiting_again_.insert(number_of(reject.seq));
      numbers_.erase(reject.seq);
    } else {
      end(CarriedNoticeKind::rejected, reject.seq, words_of_reject(reject));
    }
  }
  for (const ClientSequence seq : changes.durable) end(CarriedNoticeKind::durable, seq, "");
  for (const ClientSequence seq : changes.unseen) end(CarriedNoticeKind::unseen, seq, "");
  if (waiting_again_.empty()) return;
  for (const auto& [seq, local] : session_.replica().local_edits().all()) {
    if (local.again_of != 0 && waiting_again_.erase(local.again_of) != 0)
      numbers_[seq] = local.again_of;
  }
  for (auto it = waiting_again_.begin(); it != waiting_again_.end();) {
    if (session_.keeps_lost_edit(*it)) {
      ++it;
      continue;
    }
    note(CarriedNoticeKind::rejected, static_cast<std::uint32_t>(*it),
         "the edit was lost and cannot be offered again");
    it = waiting_again_.erase(it);
  }
}

void CarriedSession::note(CarriedNoticeKind kind, std::uint32_t number, std::string text) {
  notices_.push_back({kind, number, std::move(text)});
  if (notices_.size() > kNoticesMax) notices_.pop_front();
}

ByteView CarriedSession::next_frame() {
  if (frames_taken_ == frames_.size()) {
    frames_.clear();
    frames_taken_ = 0;
    if (stream_) stream_->write(frames_, kWriteBytes);
  }
  const ByteView left = ByteView(frames_).subspan(frames_taken_);
  if (left.empty()) return {};
  const std::size_t bytes = frame_bytes(left);
  frames_taken_ += bytes;
  return left.first(bytes);
}

bool CarriedSession::wants_close() const {
  if (!stream_) return false;
  const bool is_sent = frames_taken_ == frames_.size() && !stream_->has_output();
  return is_overfull_ || (session_.wants_close() && is_sent);
}

void CarriedSession::move(const WorldPos& eye, double yaw, double pitch) {
  constexpr double kPi = std::numbers::pi;
  const double turns = yaw / (2 * kPi);
  Pose pose;
  pose.at = eye;
  pose.yaw = static_cast<std::uint16_t>(std::llround((turns - std::floor(turns)) * 65536) & 65535);
  pose.pitch = static_cast<std::int16_t>(std::lround(std::clamp(pitch / kPi, -0.5, 0.5) * 32767));
  session_.set_pose(pose);
  moved_to_ = eye;
  centre_view(eye);
}

void CarriedSession::centre_view(const WorldPos& eye) {
  const std::int32_t edge = session_.replica().chunk_edge();
  if (edge == 0) return;
  const auto voxel = [](double along) { return static_cast<std::int32_t>(std::floor(along)); };
  const ChunkCoord centre = chunk_of({voxel(eye.x), voxel(eye.y), voxel(eye.z)}, edge);
  planner_.set_eye(centre);
  if (centre == view_.centre) return;
  view_.centre = centre;
  session_.set_view(view_);
  take_changes();
  planner_.view_changed();
}

Result<ClientSequence, std::string> CarriedSession::edit(const EditDescriptor& edit,
                                                         TimeUs now_us) {
  now_us_ = now_us;
  const auto seq = session_.offer(edit, now_us, now_us);
  if (!seq) return failure(session_.refusal_text(edit, seq.error()));
  queue_outgoing();
  take_changes();
  return *seq;
}

Result<void, std::string> CarriedSession::chat(std::string_view line) {
  auto sent = session_.chat(line);
  queue_outgoing();
  return sent;
}

Result<void, std::string> CarriedSession::command(std::string text) {
  note_command_end();
  if (const auto sent = session_.command(std::move(text)); !sent) return failure(sent.error().what);
  is_commanding_ = true;
  queue_outgoing();
  return {};
}

void CarriedSession::note_command_end() {
  if (!is_commanding_ || session_.commanding()) return;
  is_commanding_ = false;
  std::string text;
  for (const std::string& line : session_.command_lines()) {
    if (!text.empty()) text += '\n';
    text += line;
  }
  note(CarriedNoticeKind::command, session_.command_ok() ? 1 : 0, std::move(text));
}

void CarriedSession::leave() {
  session_.close(GoodbyeReason::closing, "");
  queue_outgoing();
}

std::optional<CarriedMesh> CarriedSession::next_mesh() {
  take_changes();
  if (!gone_.empty()) {
    const ChunkKey key = gone_.front();
    gone_.pop_front();
    return CarriedMesh{key.at, nullptr};
  }
  while (const auto job = planner_.next()) {
    MeshNeighbours neighbours{};
    MeshBorders borders{};
    for (std::size_t d = 0; d < neighbours.size(); ++d) {
      neighbours[d] = job->neighbours[d].get();
      borders[d] = job->borders[d].get();
    }
    const auto mesh = std::make_shared<ChunkMesh>();
    BordersPtr made;
    if (job->before) {
      *mesh = *job->before;
      mesh_chunk_layers(*job->chunk, neighbours, borders, materials_, job->changed.here,
                        job->changed.beyond, scratch_, *mesh);
    } else {
      ChunkBorders own;
      mesh_chunk(*job->chunk, neighbours, borders, materials_, scratch_, *mesh, &own);
      if (!own.empty()) made = std::make_shared<const ChunkBorders>(std::move(own));
    }
    if (!planner_.finish(job->key, job->number, mesh, job->chunk, std::move(made))) continue;
    if (mesh->empty()) {
      // A chunk of air that was never drawn needs no report.
      if (drawn_.erase(job->key) == 0) continue;
      return CarriedMesh{job->key.at, nullptr};
    }
    drawn_.insert(job->key);
    return CarriedMesh{job->key.at, mesh};
  }
  return std::nullopt;
}

std::optional<CarriedNotice> CarriedSession::next_notice() {
  if (notices_.empty()) return std::nullopt;
  CarriedNotice out = std::move(notices_.front());
  notices_.pop_front();
  return out;
}

std::optional<RayHit> CarriedSession::pick(const WorldPos& eye, const LookDirection& look,
                                           double reach) const {
  return runstone::pick(session_.replica(), ShapeTable(), eye, look, reach);
}

}  // namespace runstone
