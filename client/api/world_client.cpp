#include "client/api/world_client.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <new>
#include <utility>

#include "client/api/chunk_reports.hpp"
#include "client/api/edit_outcomes.hpp"
#include "client/api/event_queue.hpp"
#include "client/api/joined_session.hpp"
#include "client/net/wake_up.hpp"
#include "client/schedule/memory_budget.hpp"
#include "client/schedule/view_pace.hpp"
#include "common/core/material_row.hpp"
#include "common/materials/material_table.hpp"
#include "common/mesh_materials/mesh_materials_of.hpp"
#include "common/os/steady_clock.hpp"
#include "protocol/codec/key_fingerprint.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

static_assert(kEditsWaitingMax == kLocalEditsMax);
static_assert(kNewAction == kBeginsAction);

/// step() is due this often, because the session needs its ticks.
constexpr unsigned kStepMs = 10;
/// The memory budget treats a view as complete if its chunks have been here for this long.
constexpr TimeUs kCompleteUs = 2'000'000;

Pose pose_of(const ClientPlace& place) {
  const double turns = place.yaw_degrees / 360;
  Pose pose;
  pose.at = place.at;
  pose.yaw = static_cast<std::uint16_t>(std::llround((turns - std::floor(turns)) * 65536) & 65535);
  pose.pitch = static_cast<std::int16_t>(std::lround(place.pitch_degrees / 180 * 32768));
  return pose;
}

ClientPlace place_of(const Pose& pose) {
  return {pose.at, pose.yaw / 65536.0 * 360, pose.pitch / 32768.0 * 180};
}

bool is_in_world(const WorldPos& at) {
  const auto fits = [](double value) {
    return std::isfinite(value) && std::abs(value) < double{kWorldLimit};
  };
  return fits(at.x) && fits(at.y) && fits(at.z);
}

bool is_valid(const ClientPlace& place) {
  return is_in_world(place.at) && std::isfinite(place.yaw_degrees) && place.pitch_degrees >= -90 &&
         place.pitch_degrees <= 90;
}

ChunkCoord chunk_at(const WorldPos& at, std::int32_t edge) {
  const auto whole = [](double value) { return static_cast<std::int32_t>(std::floor(value)); };
  return chunk_of({whole(at.x), whole(at.y), whole(at.z)}, edge);
}

ChatReceived::From from_of(ChatLineKind kind) {
  switch (kind) {
    case ChatLineKind::player:
      return ChatReceived::From::player;
    case ChatLineKind::server:
      return ChatReceived::From::server;
    case ChatLineKind::message_of_the_day:
      return ChatReceived::From::message_of_the_day;
    case ChatLineKind::refused:
      return ChatReceived::From::refused;
    case ChatLineKind::visit:
      return ChatReceived::From::visit;
  }
  return ChatReceived::From::other;
}

Unexpected<ClientRefusal> refused(ErrorCode code, std::string text) {
  return {ClientRefusal{code, std::move(text)}};
}

ClientWorld info_of(const ClientSession& session) {
  const Welcome& welcome = *session.welcome();
  ClientWorld out;
  out.id = welcome.world_id;
  out.chunk_edge = welcome.chunk_edge;
  out.y_min = welcome.heights.y_min;
  out.y_max = welcome.heights.y_max;
  out.edit_volume_max = welcome.edit_volume_max;
  out.spawn = welcome.spawn;
  out.author = session.author();
  out.name = session.name();
  out.server_fingerprint = key_fingerprint(welcome.server_key);
  return out;
}

}  // namespace

struct WorldClient::State {
  explicit State(const WorldClientOptions& options)
      : user_wake(options.wake),
        wanted{options.view_radius, options.view_radius_vertical},
        budget(options.memory_mib << 20, wanted) {}

  void step();
  void open(const WorldOpened& event);
  void take_materials(bool is_another);
  void take_changes();
  void take_news();
  void follow(TimeUs now_us);
  void limit_memory(TimeUs now_us);
  void set_view(View view);
  bool is_complete() const;

  ClientSession& session() const { return joined->session(); }

  const std::function<void()> user_wake;
  WakeUp wake_up;
  EventQueue events;
  EditOutcomes edits;
  std::optional<ClientWorld> world;
  ClientPlace place;
  std::optional<WorldId> placed_in;  // the world of `place`
  ViewRadii wanted;
  MemoryBudget budget;
  ViewPace pace;
  std::optional<TimeUs> complete_since_us;
  std::vector<MaterialRow> materials;
  MeshMaterialsPtr mesh_materials = std::make_shared<MeshMaterials>();
  std::uint64_t shapes_number = 0;  // of the session, when `materials` was made
  std::uint64_t players_serial = 0;
  bool has_new_materials = false, has_other_players = false;  // not drained
  bool is_commanding = false;                                 // CommandDone is to come
  bool has_answer = false;                                    // CommandDone was not drained
  std::unique_ptr<JoinedSession> joined;                      // set by connect()
  std::optional<ChunkReports> chunks;                         // set by connect()
};

void WorldClient::State::step() {
  joined->receive();
  for (WorldEvent& event : joined->take_events()) {
    const auto* opened = std::get_if<WorldOpened>(&event);
    if (opened != nullptr) open(*opened);
    events.push(std::move(event));
  }
  const TimeUs now_us = steady_now_us();
  take_changes();
  take_news();
  limit_memory(now_us);
  follow(now_us);
  joined->step_cache(now_us, budget.room({session().replica().chunk_bytes(),
                                          session().replica().local_edits().bytes()}));
  session().tick(now_us);
  joined->flush();
  take_changes();
}

void WorldClient::State::open(const WorldOpened& event) {
  // The changes so far belong to the world before.
  take_changes();
  if (event.is_another && world) edits.world_changed(events);
  world = info_of(session());
  if (placed_in != world->id) {
    placed_in = world->id;
    place = session().place() ? place_of(*session().place()) : ClientPlace{world->spawn};
    if (!is_valid(place)) place = {};
  }
  take_materials(event.is_another);
  const std::uint8_t radius_max = session().welcome()->view_radius_max;
  budget.set_wanted({std::min(wanted.h, radius_max), std::min(wanted.v, radius_max)});
  complete_since_us.reset();
}

/// Takes over the materials of the session. `is_another`: they are of another world.
void WorldClient::State::take_materials(bool is_another) {
  const MaterialTable& table = session().welcome()->materials;
  const bool has_shapes =
      std::exchange(shapes_number, session().shapes_number()) != session().shapes_number();
  const std::size_t known = materials.size();
  if (!is_another && !has_shapes && table.size() == known) return;
  materials.clear();
  for (const MaterialInfo& row : table.rows()) materials.push_back(row_of(row));
  mesh_materials = mesh_materials_of(table);
  has_new_materials = true;
  if (is_another || has_shapes || table.size() < known) {
    chunks->mesh_all_again();
  } else {
    chunks->mesh_again_from(static_cast<Material>(known));
  }
}

void WorldClient::State::take_changes() {
  const ReplicaChanges changes = session().replica().drain_changes();
  chunks->take(changes.chunks, events);
  edits.take(changes, session(), events);
  for (const UnavailableChunk& chunk : changes.unavailable) events.push(ChunkMissing{chunk.key.at});
  for (const EditChange& edit : changes.edits) {
    if (edit.is_local) continue;
    OthersEdit event{edit.op.author, edit.seq, {}};
    event.chunks.reserve(edit.chunks.size());
    for (const ChunkKey& key : edit.chunks) event.chunks.push_back(key.at);
    events.push(std::move(event));
  }
}

/// Takes the other news of the session.
void WorldClient::State::take_news() {
  if (session().is_open()) take_materials(false);
  if (std::exchange(players_serial, session().players_serial()) != session().players_serial())
    has_other_players = true;
  for (ChatLine& line : session().drain_chat())
    events.push(
        ChatReceived{from_of(line.kind), std::move(line.name), std::move(line.text), line.utc_us});
  if (!is_commanding || session().commanding()) return;
  is_commanding = false;
  has_answer = true;
  events.push(
      CommandDone{session().command_ok(), session().is_answer_lost(), session().command_lines()});
}

void WorldClient::State::follow(TimeUs now_us) {
  session().set_pose(pose_of(place));
  if (!session().replica().opened()) return;
  View view = session().view();
  view.centre = chunk_at(place.at, session().replica().chunk_edge());
  view.yaw = pose_of(place).yaw;
  view.pitch = pose_of(place).pitch;
  view.cone = kSightCone;
  view.radius_h = budget.radii().h;
  view.radius_v = budget.radii().v;
  if (pace.step(session().view(), view, now_us)) set_view(view);
}

void WorldClient::State::set_view(View view) {
  session().set_view(view);
  take_changes();
  chunks->view_changed();
  chunks->set_eye(view.centre);
}

void WorldClient::State::limit_memory(TimeUs now_us) {
  const Replica& replica = session().replica();
  if (!replica.opened()) return;
  if (!is_complete()) {
    complete_since_us.reset();
  } else if (!complete_since_us) {
    complete_since_us = now_us;
  }
  const bool is_whole = complete_since_us && now_us - *complete_since_us >= kCompleteUs;
  if (!budget.step({replica.chunk_bytes(), replica.local_edits().bytes()}, is_whole, now_us))
    return;
  View view = session().view();
  view.radius_h = budget.radii().h;
  view.radius_v = budget.radii().v;
  set_view(view);
}

bool WorldClient::State::is_complete() const {
  return session().is_open() &&
         session().view().centre == chunk_at(place.at, session().replica().chunk_edge()) &&
         session().loaded();
}

Result<WorldClient, std::string> WorldClient::connect(WorldClientOptions options) {
  try {
    auto state = std::make_unique<State>(options);
    auto joined = JoinedSession::start(options, [raw = state.get()] {
      raw->wake_up.notify();
      if (raw->user_wake) raw->user_wake();
    });
    if (!joined) return failure(joined.error());
    state->joined = *std::move(joined);
    state->chunks.emplace(state->session().replica());
    return WorldClient(std::move(state));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return failure(std::string(error.what()));
  }
}

WorldClient::WorldClient(std::unique_ptr<State> state) : state_(std::move(state)) {}

WorldClient::~WorldClient() { close_if_any(); }

WorldClient::WorldClient(WorldClient&&) noexcept = default;

WorldClient& WorldClient::operator=(WorldClient&& other) noexcept {
  if (this == &other) return *this;
  close_if_any();
  state_ = std::move(other.state_);
  return *this;
}

void WorldClient::close_if_any() noexcept {
  if (!state_) return;
  try {
    close();
  } catch (const std::exception&) {
    // Memory ran out before the goodbye. The threads end with the state.
  }
}

void WorldClient::step() {
  if (!state_->joined->is_ended()) state_->step();
}

bool WorldClient::has_more() const { return state_->joined->has_more(); }

void WorldClient::wait(unsigned milliseconds) {
  if (!has_more()) state_->wake_up.wait(std::chrono::milliseconds(std::min(milliseconds, kStepMs)));
}

std::vector<WorldEvent> WorldClient::drain(std::size_t chunks_max) {
  State& state = *state_;
  state.take_changes();
  std::vector<WorldEvent> out = state.events.drain();
  state.has_answer = false;
  if (std::exchange(state.has_new_materials, false)) out.emplace_back(MaterialsChanged{});
  if (std::exchange(state.has_other_players, false)) out.emplace_back(PlayersChanged{});
  for (; chunks_max != 0; --chunks_max) {
    auto chunk = state.chunks->next();
    if (!chunk) break;
    out.emplace_back(*std::move(chunk));
  }
  return out;
}

std::size_t WorldClient::outdated_count() const {
  state_->take_changes();
  return state_->chunks->count();
}

ConnectionState WorldClient::state() const {
  if (state_->joined->is_ended()) return ConnectionState::ended;
  return state_->session().is_open() ? ConnectionState::open : ConnectionState::connecting;
}

const std::optional<ClientWorld>& WorldClient::world() const { return state_->world; }

bool WorldClient::is_complete() const { return state_->world && state_->is_complete(); }

Result<void, ClientRefusal> WorldClient::move(const ClientPlace& place) {
  if (!state_->world) return refused(ErrorCode::bad_value, "no world is open");
  if (!is_valid(place)) return refused(ErrorCode::bad_value, "this place is outside of the world");
  state_->place = place;
  return {};
}

const ClientPlace& WorldClient::place() const { return state_->place; }

Result<void, ClientRefusal> WorldClient::set_view_radii(std::uint8_t horizontal,
                                                        std::uint8_t vertical) {
  if (horizontal > kViewRadiusMax || vertical > kViewRadiusMax)
    return refused(ErrorCode::limit_exceeded, "a view has a radius of 0 to 64 chunks");
  State& state = *state_;
  state.wanted = {horizontal, vertical};
  const auto& welcome = state.session().welcome();
  const std::uint8_t radius_max = welcome ? welcome->view_radius_max : std::uint8_t{kViewRadiusMax};
  state.budget.set_wanted({std::min(horizontal, radius_max), std::min(vertical, radius_max)});
  return {};
}

Result<EditNumber, ClientRefusal> WorldClient::submit(const EditDescriptor& edit,
                                                      EditNumber action) {
  State& state = *state_;
  if (!state.world || state.joined->is_ended())
    return refused(ErrorCode::bad_value, "no world is open");
  if (const auto valid = validate(edit); !valid)
    return refused(valid.error().code, valid.error().what);
  if (!has_voxels(edit)) return refused(ErrorCode::unknown_kind, "the edit has no voxels");
  if (state.events.edit_events() + state.edits.count() >= kEditsWaitingMax)
    return refused(ErrorCode::limit_exceeded,
                   "too many edits wait for the server, or to be drained");
  const TimeUs now_us = steady_now_us();
  const auto seq = state.session().offer(edit, now_us, now_us, action);
  if (!seq) {
    return refused(seq.error().code, state.session().refusal_text(edit, seq.error()));
  }
  state.edits.add(*seq);
  state.joined->flush();
  return *seq;
}

TimeUs WorldClient::wait_us(const EditDescriptor& edit) const {
  if (!state_->world || !validate(edit)) return 0;
  return state_->session().edit_wait_us(edit, steady_now_us());
}

Result<void, ClientRefusal> WorldClient::chat(std::string_view line) {
  if (state_->joined->is_ended()) return refused(ErrorCode::bad_value, "no world is open");
  auto sent = state_->session().chat(line);
  if (!sent) return refused(ErrorCode::bad_value, sent.error());
  state_->joined->flush();
  return {};
}

Result<void, ClientRefusal> WorldClient::command(std::string_view text) {
  if (state_->joined->is_ended()) return refused(ErrorCode::bad_value, "no world is open");
  if (state_->is_commanding)
    return refused(ErrorCode::bad_value, "the previous command is still running");
  if (state_->has_answer)
    return refused(ErrorCode::bad_value, "the answer of the previous command was not drained");
  auto sent = state_->session().command(std::string(text));
  if (!sent) return refused(sent.error().code, sent.error().what);
  state_->is_commanding = true;
  state_->joined->flush();
  return {};
}

std::shared_ptr<const RunChunk> WorldClient::chunk(ChunkCoord at) const {
  return state_->session().replica().shown({0, at});
}

std::optional<MeshSource> WorldClient::mesh_source(ChunkCoord at) const {
  return state_->chunks->source(at);
}

std::optional<Material> WorldClient::material_at(VoxelPos at) const {
  if (!is_in_world({double(at.x), double(at.y), double(at.z)})) return std::nullopt;
  return state_->session().replica().shown_at(at);
}

std::vector<ChunkCoord> WorldClient::chunks() const {
  const Replica& replica = state_->session().replica();
  std::vector<ChunkCoord> out;
  for (const ChunkKey& key : replica.confirmed_keys()) {
    if (replica.shown(key)) out.push_back(key.at);
  }
  return out;
}

const std::vector<MaterialRow>& WorldClient::materials() const { return state_->materials; }

std::optional<Material> WorldClient::find_material(std::string_view name) const {
  const auto& rows = state_->materials;
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [&](const MaterialRow& row) { return row.name == name; });
  if (found == rows.end()) return std::nullopt;
  return static_cast<Material>(found - rows.begin());
}

std::shared_ptr<const MeshMaterials> WorldClient::mesh_materials() const {
  return state_->mesh_materials;
}

std::vector<PlayerInfo> WorldClient::players() const {
  std::vector<PlayerInfo> out;
  for (const auto& [author, player] : state_->session().others()) {
    if (player.name.empty()) continue;  // its pose came before its name
    PlayerInfo info{author, player.name, player.role, std::nullopt};
    if (player.pose) info.place = place_of(*player.pose);
    out.push_back(std::move(info));
  }
  return out;
}

void WorldClient::close() { state_->joined->stop(); }

}  // namespace runstone
