#include "client/web/web_client.hpp"

#include <algorithm>
#include <utility>

#include "client/web/page.hpp"
#include "common/core/hex.hpp"
#include "common/core/text.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {
namespace {

/// The times that a turn gives to what was received and to meshes. Frames of 60 a second take 16
/// ms, and drawing needs some of them.
constexpr TimeUs kReceiveUs = 4'000, kMeshUs = 6'000;
/// The times while the player joins. The page shows no world then, so long frames disturb nobody.
constexpr TimeUs kJoinReceiveUs = 12'000, kJoinMeshUs = 24'000;
/// Joining ends this long after the world opened, if there is no ground before.
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

PlayConfig play_config(const JoinOptions& options) {
  PlayConfig out;
  out.wishes = {
      options.memory_mib, {options.view_radius, options.view_radius_v}, options.far_levels};
  out.keys = browser_keys();
  out.started_us = steady_now_us();
  out.kit_of = [](const WorldId& world) {
    std::array<char, kKitBytesMax + 1> line{};
    page_read_kit(to_hex(world).c_str(), line.data(), static_cast<int>(line.size()));
    return parse_kit(line.data());
  };
  return out;
}

}  // namespace

WebClient::WebClient(const JoinOptions& options, Screen& screen)
    : screen_(screen),
      network_(options),
      session_(network_.session()),
      play_(session_, tools_, &queue_, log_, play_config(options)),
      pipeline_(play_.pipeline()),
      windows_(play_.input().keys()),
      hud_(play_),
      pins_kept_(options.pinned.size()) {
  settings_.shows_textures = options.shows_textures;
  queue_.set_drawing(screen.name());
  pipeline_.set_measures_frames(false);
  pipeline_.look().set_quality(options.quality);
}

void WebClient::turn(TimeUs now_us, bool draws) {
  if (is_over_) return;
  network_.step(now_us, now_us + (is_joined_ ? kReceiveUs : kJoinReceiveUs));
  const bool is_opened = network_.take_world_opened();
  if (is_opened) keep_server_key();
  play_.begin_turn(is_opened, windows_.shown(), steady_now_us());
  handle_input(now_us);
  pipeline_.take_drawn();
  hud_.step();
  for (const KeptKit& kept : play_.take_kits())
    page_keep_kit(to_hex(kept.world).c_str(), to_text(kept.kit).c_str());
  flush(now_us);  // local edits go first
  play_.follow(now_us);
  network_.step_cache(play_.limits().room(), now_us);  // the view names the chunks that were found
  play_.step_textures(settings_, now_us);
  session_.tick(now_us);
  if (is_joined_) network_.keep_chunks(now_us);
  flush(now_us);
  play_.step_previews(settings_, now_us);
  mesh_until(steady_now_us() + (is_joined_ ? kMeshUs : kJoinMeshUs));
  if (draws) {
    draw(now_us);
  } else {
    drawn_us_.reset();
  }
  share_keyboard();
  show_state(now_us);
}

void WebClient::flush(TimeUs now_us) {
  network_.flush(now_us);
  play_.take_changes(steady_now_us());
}

void WebClient::keep_server_key() {
  const auto& pinned = session_.pinned();
  if (pinned.size() == pins_kept_) return;
  pins_kept_ = pinned.size();
  const Welcome& welcome = *session_.welcome();
  page_keep_server(to_hex(welcome.world_id).c_str(), to_hex(welcome.server_key).c_str());
}

void WebClient::capture(bool is_captured) {
  if (is_captured) {
    play_.input().capture();
  } else {
    play_.input().release();
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
  play_.input().push({CursorEvent{x * pixels, y * pixels, dx, dy}});
}

bool WebClient::has_window_at(double x, double y) const {
  const double pixels = size_[0] / page_width_;
  return windows_.has_window_at(x * pixels, y * pixels);
}

void WebClient::touch(int id, int phase, double x, double y) {
  const bool begins = phase == 0, moves = phase == 1;
  if (begins && !window_touch_ && has_window_at(x, y)) {
    window_touch_ = id;
    play_.input().release();
  }
  if (window_touch_ == id) {
    if (begins || moves) move_mouse(x, y, 0, 0);
    if (!moves) play_.input().push({ButtonEvent{MouseButton::left, begins}});
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
  touch_.step(now_us);
  play_.input().push(touch_.take_events());
  const RoutedInput routed = play_.handle_input(windows_.focus(), settings_, now_us);
  for (const Action action : routed.player.actions) act(action);
  share_mouse();  // the tool window counts a captured mouse as a click beside it
  if (!routed.for_ui.empty() && windows_.is_any_open()) {
    windows_.feed(routed.for_ui);
    // The windows take the events now, so that they know before the next ones whether they type.
    static_cast<void>(make_windows(now_us));
    pipeline_.moved();
  }
  share_mouse();
}

void WebClient::share_keyboard() {
  const bool types = windows_.focus().types;
  if (std::exchange(types_, types) != types) page_typing(types ? 1 : 0);
}

void WebClient::share_mouse() {
  const bool was_captured = play_.input().is_captured();
  play_.input().set_windows(false, windows_.focus().panels);
  if (play_.input().is_captured() != was_captured)
    page_capture(play_.input().is_captured() ? 1 : 0);
}

std::shared_ptr<const OverlayFrame> WebClient::make_windows(TimeUs now_us) {
  const TimeUs before_us = std::exchange(windows_us_, now_us);
  HudState state;
  play_.fill(state, windows_.shown());
  state.is_connected = network_.is_connected();
  auto frame = windows_.make_frame(state, size_, static_cast<double>(now_us - before_us) / 1e6);
  for (const UiAction& action : windows_.take_actions()) play_.carry_out(action, now_us);
  return frame;
}

void WebClient::act(Action action) {
  if (play_.act(action, steady_now_us())) return;
  if (action != Action::timeline && windows_.act(action)) return;
  switch (action) {
    case Action::chat:
    case Action::command:
      play_.input().release();
      return page_open_chat();
    case Action::palette:
      play_.input().release();
      return page_toggle_palette();
    case Action::timeline:
      play_.input().release();
      return page_toggle_timeline();
    default:
      return;
  }
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
  play_.keep_pace(true, false, now_us);
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
  const auto field_of_view = is_exact_ ? std::nullopt : std::optional<double>(kFieldOfView);
  FrameOrder order = play_.frame({field_of_view, !is_exact_, false, size_}, now_us);
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
  if (!play_.was_opened()) {
    const char* step = "showing your key to the server";
    if (session_.state() == SessionState::offline) step = "connecting";
    if (session_.state() == SessionState::hello_sent) step = "greeting the server";
    const std::string why =
        words.headline.empty() ? "" : words.headline + ". Trying again. " + words.detail;
    return page_progress(step, -1, why.c_str());
  }
  if (!is_joined_) {
    if (play_.has_ground(kGroundWaitUs, now_us)) {
      is_joined_ = true;
      return page_joined();
    }
    const double share = static_cast<double>(pipeline_.meshed_count()) / Play::kGroundChunks;
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
  const std::string state = play_.state_text();
  return state.empty() ? play_.tool().text() : state;
}

void WebClient::leave() {
  is_over_ = true;
  network_.leave();
}

void WebClient::set_camera(const WorldPos& eye, double yaw, double pitch, bool is_exact) {
  play_.player().move_to(eye);
  play_.player().look(yaw, pitch);
  is_exact_ = is_exact;
  pipeline_.look().set_exact(is_exact);
  pipeline_.moved();
}

bool WebClient::is_complete() const {
  return session_.is_open() && play_.view().is_complete() && pipeline_.is_up_to_date();
}

std::string WebClient::report_json() const {
  ClientReport out;
  play_.add_to(out, steady_now_us());
  network_.add_to(out);
  return to_json(out, session_);
}

}  // namespace runstone
