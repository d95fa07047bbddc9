#include "client/web/web_client.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "client/panels/panel_actions.hpp"
#include "client/play/time_travel.hpp"
#include "client/play/tool_actions.hpp"
#include "client/play/wheel_actions.hpp"
#include "client/web/page.hpp"
#include "common/core/hex.hpp"
#include "common/core/text.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {
namespace {

/// The times that a turn gives to what was received and to meshes. Frames of 60 a second take 16
/// ms, and drawing needs some of them.
constexpr TimeUs kReceiveUs = 4'000, kMeshUs = 6'000;
/// The same while the player joins. The page shows no world then, so long frames disturb nobody.
constexpr TimeUs kJoinReceiveUs = 12'000, kJoinMeshUs = 24'000;
/// Joining ends with this many meshed chunks, or this long after the world opened.
constexpr std::uint64_t kGroundChunks = 27;
constexpr TimeUs kGroundWaitUs = 5'000'000;
/// A frame that follows the one before within this time has kept pace with a display of 60 Hz.
/// Shorter times cannot be measured, because the browser waits for the display.
constexpr TimeUs kPaceUs = 20'000;
/// The frame time that LookControl gets for a frame that kept pace.
constexpr TimeUs kPaceTookUs = 8'000;
constexpr double kFieldOfView = 69;  // degrees, vertical
/// The windows have their full size on pages that are at least as wide, in pixels of the page.
constexpr double kWindowsWidth = 480;

/// Returns the default keys, but V for flying faster: browsers close their tab for ctrl+W, and a
/// page cannot prevent it.
KeyMap browser_keys() {
  KeyMap keys;
  keys.bind(Action::move_fast, {{Key::v}});
  return keys;
}

ViewRadii radii_of(const JoinOptions& options) {
  return {options.view_radius, options.view_radius_v};
}

}  // namespace

WebClient::WebClient(const JoinOptions& options, Screen& screen)
    : screen_(screen),
      started_us_(steady_now_us()),
      network_(options),
      session_(network_.session()),
      pipeline_(session_.replica(), &queue_, true, 0, nullptr),
      tool_(session_, player_, pipeline_.recorder(), tools_),
      motion_(session_.replica(), player_),
      clicks_(tool_),
      view_(session_, player_, radii_of(options), options.far_levels),
      limits_({options.memory_mib, radii_of(options), options.far_levels}, session_.replica(),
              pipeline_, view_),
      panels_(session_, player_, tools_),
      windows_(input_.keys()),
      scene_(session_, player_, tool_, view_),
      hud_(session_, player_),
      pins_kept_(options.pinned.size()),
      input_us_(started_us_) {
  input_.set_keys(browser_keys());
  queue_.set_drawing(screen.name());
  pipeline_.set_measures_frames(false);
  pipeline_.look().set_quality(options.quality);
}

void WebClient::turn(TimeUs now_us, bool draws) {
  if (is_over_) return;
  network_.step(now_us, now_us + (is_joined_ ? kReceiveUs : kJoinReceiveUs));
  if (network_.take_world_opened()) on_world_opened();
  take_new_materials();
  drain_changes();
  if (panels_.step(windows_.shown(), now_us)) pipeline_.moved();
  limit_memory(now_us);
  handle_input(now_us);
  pipeline_.take_drawn();
  hud_.step();
  view_.update_completeness(now_us);
  network_.flush(now_us);  // local edits go first
  follow_player(now_us);
  network_.step_cache(limits_.room(), now_us);  // the view names the chunks that were found
  session_.tick(now_us);
  if (is_joined_) network_.keep_chunks(now_us);
  network_.flush(now_us);
  drain_changes();
  if (tool_.step_preview()) pipeline_.moved();
  mesh_until(steady_now_us() + (is_joined_ ? kMeshUs : kJoinMeshUs));
  if (draws) {
    draw(now_us);
  } else {
    drawn_us_.reset();
  }
  share_keyboard();
  show_state(now_us);
}

void WebClient::on_world_opened() {
  if (!opened_us_) opened_us_ = steady_now_us();
  const Welcome& welcome = *session_.welcome();
  player_.enter(welcome.world_id, welcome.spawn);
  pipeline_.set_materials(welcome.materials);
  motion_.set_materials(welcome.materials);
  set_tool_materials(welcome.materials);
  if (std::exchange(world_, welcome.world_id) != welcome.world_id) {
    hud_.enter(welcome.materials);
  } else {
    hud_.add_materials(welcome.materials);
  }
  limits_.open_world(welcome.view_radius_max);
  keep_server_key();
}

void WebClient::keep_server_key() {
  const auto& pinned = session_.pinned();
  if (pinned.size() == pins_kept_) return;
  pins_kept_ = pinned.size();
  const Welcome& welcome = *session_.welcome();
  page_keep_server(to_hex(welcome.world_id).c_str(), to_hex(welcome.server_key).c_str());
}

void WebClient::take_new_materials() {
  if (!session_.is_open()) return;
  const MaterialTable& materials = session_.welcome()->materials;
  if (materials.size() <= pipeline_.materials().size()) return;
  pipeline_.set_materials(materials);
  motion_.set_materials(materials);
  set_tool_materials(materials);
  hud_.add_materials(materials);
}

void WebClient::set_tool_materials(const MaterialTable& materials) {
  panels_.set_materials(materials);
  const std::string lost = tools_.set_materials(materials);
  if (!lost.empty()) hud_.notify(with_unseen_replaced(lost), true);
}

void WebClient::drain_changes() {
  const ReplicaChanges changes = session_.replica().drain_changes();
  pipeline_.take(changes, session_.clock(), steady_now_us());
  panels_.take(changes);
  hud_.take(changes);
}

void WebClient::limit_memory(TimeUs now_us) {
  if (limits_.limit_view(now_us)) drain_changes();
  limits_.limit_meshes();
  if (limits_.limit_far(now_us)) drain_changes();
}

void WebClient::capture(bool is_captured) {
  if (is_captured) {
    input_.capture();
  } else {
    input_.release();
  }
}

void WebClient::set_size(std::array<int, 2> pixels, double page_width, double page_height) {
  size_ = pixels;
  page_width_ = std::max(page_width, 1.0);
  touch_.set_size(page_width, page_height);
  pipeline_.moved();
}

void WebClient::set_font(ByteView font) {
  const double pixels = size_[0] / page_width_;  // for each pixel of the page
  windows_.set_font(font, pixels * std::min(1.0, page_width_ / kWindowsWidth));
  pipeline_.moved();
}

void WebClient::move_mouse(double x, double y, double dx, double dy) {
  const double pixels = size_[0] / page_width_;
  push(CursorEvent{x * pixels, y * pixels, dx, dy});
}

bool WebClient::has_window_at(double x, double y) const {
  const double pixels = size_[0] / page_width_;
  return windows_.has_window_at(x * pixels, y * pixels);
}

void WebClient::touch(int id, int phase, double x, double y) {
  const bool begins = phase == 0, moves = phase == 1;
  if (begins && !window_touch_ && has_window_at(x, y)) {
    window_touch_ = id;
    input_.release();
  }
  if (window_touch_ == id) {
    if (begins || moves) move_mouse(x, y, 0, 0);
    if (!moves) push(ButtonEvent{MouseButton::left, begins});
    if (!begins && !moves) window_touch_.reset();
    return;
  }
  capture(true);
  const TimeUs now_us = steady_now_us();
  if (phase == 0) touch_.begin(id, x, y, now_us);
  if (phase == 1) touch_.move(id, x, y);
  if (phase == 2) touch_.end(id, now_us);
  if (phase == 3) touch_.cancel();
}

void WebClient::handle_input(TimeUs now_us) {
  const double seconds = static_cast<double>(now_us - std::exchange(input_us_, now_us)) / 1e6;
  touch_.step(now_us);
  input_.push(touch_.take_events());
  const RoutedInput routed = input_.route(windows_.focus());
  const bool was_waiting = player_.is_waiting_for_ground();
  motion_.step(routed.player, std::min(seconds, 0.1), {});
  if (player_.take_fallen_out()) {
    hud_.notify("you fell out of the world: you are at its spawn, and fly", true);
    page_walking(0);
  }
  if (was_waiting != player_.is_waiting_for_ground()) pipeline_.moved();
  for (const std::string& why : clicks_.step(routed.player, true, now_us)) hud_.notify(why, true);
  if (routed.player.pick_clicks != 0) {
    if (const auto hit = tool_.pick()) hud_.hotbar().hold(hit->material);
  }
  if (const auto line = act_on_wheel(routed.player, tool_, player_, hud_.hotbar()))
    hud_.notify(*line, false);
  for (const Action action : routed.player.actions) act(action);
  share_mouse();  // the tool window counts a captured mouse as a click beside it
  if (!routed.for_ui.empty() && windows_.is_any_open()) {
    windows_.feed(routed.for_ui);
    // The windows take the events now, so that they know before the next ones whether they type.
    static_cast<void>(make_windows(now_us));
    pipeline_.moved();
  }
  share_mouse();
  if (!routed.player.actions.empty() || routed.player.scroll != 0) pipeline_.moved();
}

void WebClient::share_keyboard() {
  const bool types = windows_.focus().types;
  if (std::exchange(types_, types) != types) page_typing(types ? 1 : 0);
}

void WebClient::share_mouse() {
  const bool was_captured = input_.is_captured();
  input_.set_windows(false, windows_.focus().panels);
  if (input_.is_captured() != was_captured) page_capture(input_.is_captured() ? 1 : 0);
}

HudState WebClient::hud_state() const {
  HudState out;
  out.materials = &pipeline_.materials();
  out.slots = hud_.hotbar().slots().slots();
  out.slot = hud_.hotbar().slots().slot();
  out.is_captured = input_.is_captured();
  out.is_connected = network_.is_connected();
  if (const auto sight = tool_.pick()) {
    out.aimed_at = sight->material;
    out.sight = sight->voxel;
  }
  out.tools = &tools_;
  out.has_preview = tool_.has_preview();
  panels_.fill(out, windows_.shown());
  return out;
}

std::shared_ptr<const OverlayFrame> WebClient::make_windows(TimeUs now_us) {
  const TimeUs before_us = std::exchange(windows_us_, now_us);
  auto frame =
      windows_.make_frame(hud_state(), size_, static_cast<double>(now_us - before_us) / 1e6);
  for (const UiAction& action : windows_.take_actions()) {
    if (const auto done = carry_out_panel(action, session_, panels_, tool_, now_us); !done)
      hud_.notify(done.error(), true);
  }
  return frame;
}

void WebClient::act(Action action) {
  if (const auto done = act_on_tool(tool_, action, steady_now_us()))
    return hud_.notify(*done ? **done : done->error(), !*done);
  if (hud_.hotbar().act(action)) return;
  if (action != Action::timeline && windows_.act(action)) return;
  switch (action) {
    case Action::walk_or_fly:
      player_.set_walking(!player_.is_walking());
      return page_walking(player_.is_walking() ? 1 : 0);
    case Action::undo:
      return hud_.say("/undo");
    case Action::redo:
      return hud_.say("/redo");
    case Action::chat:
    case Action::command:
      input_.release();
      return page_open_chat();
    case Action::palette:
      input_.release();
      return page_toggle_palette();
    case Action::timeline:
      input_.release();
      return page_toggle_timeline();
    case Action::earlier:
      return step_in_time(session_, -1);
    case Action::later:
      return step_in_time(session_, 1);
    case Action::live:
      return show_after(session_, kSequenceShownMax);
    default:
      return;
  }
}

void WebClient::follow_player(TimeUs now_us) {
  if (view_.follow(now_us)) {
    pipeline_.view_changed();
    drain_changes();
  }
  if (!session_.replica().opened()) return;
  pipeline_.joined(session_.view(), started_us_);
  pipeline_.set_eye(player_.chunk(session_.replica().chunk_edge()));
}

void WebClient::mesh_until(TimeUs until_us) {
  // Without workers each call meshes one chunk and one tile at most.
  for (bool has_worked = true; has_worked;) {
    const std::uint64_t before = pipeline_.mesh_jobs() + pipeline_.far_jobs();
    pipeline_.mesh();
    has_worked =
        pipeline_.mesh_jobs() + pipeline_.far_jobs() != before && steady_now_us() < until_us;
  }
}

void WebClient::draw(TimeUs now_us) {
  const bool is_moving = panels_.take_moved(now_us);
  pace_.step(pipeline_, true, player_.pose(), is_moving, now_us);
  if (!pipeline_.is_frame_due(now_us)) {
    drawn_us_.reset();
    if (queue_.waiting() != 0) queue_.serve(screen_);
    return;
  }
  if (drawn_us_) {
    const TimeUs took_us = now_us - *drawn_us_;
    pipeline_.look().frame_took(took_us < kPaceUs ? kPaceTookUs : took_us);
  }
  drawn_us_ = now_us;
  pace_.drew(now_us);
  FrameOrder order;
  order.camera = scene_.camera(is_exact_ ? std::nullopt : std::optional<double>(kFieldOfView));
  order.width = size_[0];
  order.height = size_[1];
  order.contents = scene_.contents(panels_.poses(), !is_exact_, false);
  const std::span<const GhostChunk> rollback = panels_.rollback().ghosts();
  order.contents.ghosts.insert(order.contents.ghosts.end(), rollback.begin(), rollback.end());
  if (windows_.is_any_open()) order.overlay = make_windows(now_us);
  pipeline_.draw(now_us, std::move(order));
  queue_.serve(screen_);
  pipeline_.take_drawn();
}

void WebClient::show_state(TimeUs now_us) {
  FailureWords words = network_.failure_words();
  words.detail = with_unseen_replaced(words.detail);
  if (network_.is_refused()) {
    is_over_ = true;
    network_.leave();
    return page_failed(words.headline.c_str(), words.detail.c_str());
  }
  if (!opened_us_) {
    const char* step = "showing your key to the server";
    if (session_.state() == SessionState::offline) step = "connecting";
    if (session_.state() == SessionState::hello_sent) step = "greeting the server";
    const std::string why =
        words.headline.empty() ? "" : words.headline + ". Trying again. " + words.detail;
    return page_progress(step, -1, why.c_str());
  }
  if (!is_joined_) {
    const bool has_ground = session_.is_open() && pipeline_.meshed_count() >= kGroundChunks;
    if (has_ground || view_.is_complete() || now_us - *opened_us_ > kGroundWaitUs) {
      is_joined_ = true;
      return page_joined();
    }
    const double share = static_cast<double>(pipeline_.meshed_count()) / kGroundChunks;
    return page_progress("receiving the world", std::min(share, 1.0), "");
  }
  hud_.set_state(playing_text());
}

std::string WebClient::playing_text() const {
  if (!network_.is_connected()) {
    std::string out = "the server is gone: connecting again";
    const std::size_t waiting = session_.replica().local_edits().pending_count();
    if (waiting != 0) out += "; edits that wait for it: " + std::to_string(waiting);
    const FailureWords words = network_.failure_words();
    if (!words.headline.empty())
      out += " (" + words.headline + ": " + with_unseen_replaced(words.detail) + ")";
    return out;
  }
  if (const auto& past = session_.replica().past()) return moment_text(past);
  if (player_.is_waiting_for_ground()) return "the ground here has not arrived yet";
  const std::string shortage = limits_.text();
  return shortage.empty() ? tool_.text() : shortage;
}

void WebClient::leave() {
  is_over_ = true;
  network_.leave();
}

void WebClient::set_camera(const WorldPos& eye, double yaw, double pitch, bool is_exact) {
  player_.move_to(eye);
  player_.look(yaw, pitch);
  is_exact_ = is_exact;
  pipeline_.look().set_exact(is_exact);
  pipeline_.moved();
}

bool WebClient::is_complete() const {
  return session_.is_open() && view_.is_complete() && pipeline_.is_up_to_date();
}

std::string WebClient::report_json() const {
  ClientReport out;
  out.seconds = static_cast<double>(steady_now_us() - started_us_) / 1e6;
  out.edits_refused = tool_.refused();
  limits_.add_to(out, session_.view(), scene_.reach());
  network_.add_to(out);
  pipeline_.add_to(out);
  return to_json(out, session_);
}

}  // namespace runstone
