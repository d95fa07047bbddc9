#include "client/app/client.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <numbers>
#include <utility>

#include "client/app/player_defaults.hpp"
#include "client/app/tool_actions.hpp"
#include "client/display/ground_marker.hpp"
#include "client/display/player_body.hpp"
#include "client/report/exit_code.hpp"
#include "common/core/key_text.hpp"
#include "common/os/output_file.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {
namespace {

/// The longest pause of the loop. The session needs a tick at least this often.
constexpr TimeUs kRestUs = 10'000;
/// The longest pause of the loop with a window. A key or a click waits no longer than this.
constexpr TimeUs kRestUsWindow = 2'000;
/// The longest pause of the loop with a window that has no focus.
constexpr TimeUs kRestUsBackground = 10'000;
/// The time between two frames in which nothing has moved. Waves and a clock go on slowly.
constexpr TimeUs kStillFrameUs = 200'000;
constexpr TimeUs kStillFrameUsBackground = 1'000'000;
/// The least time between two frames of a window without focus, so that it leaves the processor to
/// the window in use.
constexpr TimeUs kBackgroundFrameUs = 100'000;
/// Other players count as moving for this time after a new pose.
constexpr TimeUs kPoseUs = 300'000;
/// A view whose chunks have been here for this long is taken as meshed.
constexpr TimeUs kMeshedUs = 2'000'000;
constexpr TimeUs kPlayerLogUs = 1'000'000;
/// The connecting screen ends with this many meshed chunks, or this long after the world opened.
constexpr std::uint64_t kGroundChunks = 27;
constexpr TimeUs kGroundWaitUs = 3'000'000;
/// The log is divided into this many steps of `[` and `]`.
constexpr Sequence kScrubSteps = 100;

/// Returns the terminal in which a person may type, or nullopt if there is none or a script plays.
std::optional<int> terminal_of(const Script* script) {
  if (script != nullptr || ::isatty(STDIN_FILENO) != 1) return std::nullopt;
  return STDIN_FILENO;
}

std::string moment_text(const std::optional<PastMoment>& past) {
  if (!past) return {};
  const std::time_t seconds = past->utc_us / 1'000'000;
  return fmt::format("the past: after edit {} ({:%Y-%m-%d %H:%M:%S} UTC)", past->seq,
                     fmt::gmtime(seconds));
}

std::string memory_text(const MemoryBudget& budget) {
  if (!budget.binds()) return {};
  return fmt::format("view {} of {} chunks, because memory is short", budget.radii().h,
                     budget.wanted().h);
}

InputRouter router_of(const ClientSettings& settings) {
  std::vector<std::string> warnings;
  InputRouter out;
  out.set_keys(key_map_of(settings, warnings));
  for (const std::string& warning : warnings) spdlog::warn("{}", warning);
  return out;
}

}  // namespace

Client::Client(ClientOptions options, const Script* script, ClientDisplay& display, GameMenu* menu)
    : options_(std::move(options)),
      display_(display),
      wake_(display.wake),
      network_(options_, [this] { wake_.notify(); }),
      session_(network_.session()),
      window_(display.window.get()),
      menu_(menu),
      pipeline_(session_.replica(), display.draw_thread.get(), window_ != nullptr, options_.workers,
                [this] { wake_.notify(); }),
      tool_(session_, player_, pipeline_.recorder(), display.tools),
      input_(router_of(options_.settings)),
      budget_(options_.memory_mib << 20, {options_.view_radius, options_.view_radius_v}),
      view_(session_, player_, budget_.radii()),
      chat_(session_, terminal_of(script)),
      hud_(session_, player_, pipeline_, chat_, options_.name, input_.keys()),
      actions_(session_, player_, pipeline_, tool_, view_, chat_, input_, hud_,
               options_.screenshot_dir) {
  shows_ground_ = options_.show_protected;
  hud_.set_shown(window_ != nullptr);
  tool_.box().show_preview(window_ != nullptr);
  if (script != nullptr) runner_.emplace(*script, actions_);
  if (options_.benchmark) benchmark_.emplace(*options_.benchmark);
  pipeline_.look().set_time_of_day(options_.time_of_day);
  pipeline_.look().set_quality(options_.quality);
  started_us_ = polled_us_ = steady_now_us();
  network_.start(started_us_);
}

Client::~Client() = default;

ClientEnd Client::run(const volatile std::sig_atomic_t& stop) {
  ClientEnd end;
  try {
    end = run_turns(stop);
  } catch (const std::exception& error) {
    // The program still writes the measurements so far and the script's failures.
    end = {kExitNoStart, false, error.what(), {"Drawing has failed", error.what()}};
  }
  if (!end.failure.empty()) std::fprintf(stderr, "runstone-client: %s\n", end.failure.c_str());
  end.exit_code = finish(end.exit_code);
  return end;
}

ClientEnd Client::run_turns(const volatile std::sig_atomic_t& stop) {
  std::optional<ClientEnd> end;
  while (!end) {
    network_.receive();
    if (network_.take_world_opened()) on_world_opened();
    take_new_materials();
    drain_changes();  // before the script asks whether all of it is drawn
    const TimeUs now_us = steady_now_us();
    limit_memory(now_us);
    poll_window();
    handle_input(now_us);
    step_menu(now_us);
    pipeline_.take_drawn();
    log_players(now_us);
    chat_.step();
    if (hud_.take_chat()) pipeline_.moved();
    view_.update_completeness(now_us);
    if (runner_) runner_->step(now_us);
    if (benchmark_ && session_.is_open()) benchmark_->step(player_, pipeline_, view_);
    flush();  // local edits go first, because following the player may take long
    follow_player(now_us);
    session_.tick(now_us);
    network_.step_cache(now_us, budget_.room(memory_use()));
    flush();
    if (tool_.step_preview()) pipeline_.moved();
    draw(now_us);
    if (stop != 0) end_requested_ = true;
    end = end_of_play(steady_now_us());
    if (!end) rest(steady_now_us());
  }
  return *end;
}

void Client::on_world_opened() {
  if (!opened_us_) {
    opened_us_ = steady_now_us();
    if (options_.settings.walks) player_.set_walking(true);
  }
  const Welcome& welcome = *session_.welcome();
  player_.enter(welcome.world_id, welcome.spawn);
  pipeline_.set_materials(welcome.materials);
  body_materials_ = body_materials(welcome.materials);
  if (std::exchange(world_, welcome.world_id) != welcome.world_id) hud_.enter(welcome.materials);
  set_tool_materials(welcome.materials);
  budget_.set_wanted({std::min(options_.view_radius, welcome.view_radius_max),
                      std::min(options_.view_radius_v, welcome.view_radius_max)});
  if (view_.radii() != budget_.radii()) view_.set_radii(budget_.radii());
}

void Client::take_new_materials() {
  const auto& welcome = session_.welcome();
  const std::size_t known = pipeline_.materials().size();
  if (!session_.is_open() || welcome->materials.size() <= known) return;
  pipeline_.set_materials(welcome->materials);
  body_materials_ = body_materials(welcome->materials);
  set_tool_materials(welcome->materials);
  spdlog::info("the world has {} new materials", welcome->materials.size() - known);
}

void Client::set_tool_materials(const MaterialTable& materials) {
  const std::string lost = tool_.box().set_materials(materials);
  if (!lost.empty()) hud_.notify(lost, NoticeKind::warning);
}

void Client::flush() {
  network_.flush();
  drain_changes();
  pipeline_.mesh();
}

void Client::poll_window() {
  if (!window_) return;
  const WindowEvents polled = window_->poll();
  if (polled.close) end_requested_ = true;
  if (feed_menu(polled)) return;
  if (!runner_) return input_.push(polled.events);
  // A script plays. Of the keyboard only escape counts.
  for (const InputEvent& event : polled.events) {
    const auto* const key = std::get_if<KeyEvent>(&event);
    if (key != nullptr && key->is_pressed && key->key == Key::escape) end_requested_ = true;
  }
}

void Client::handle_input(TimeUs now_us) {
  const double seconds = static_cast<double>(now_us - polled_us_) / 1e6;
  polled_us_ = now_us;
  const bool was_captured = input_.is_captured();
  const RoutedInput routed = input_.route(hud_.focus());
  if (menu_ != nullptr && was_captured && !input_.is_captured()) menu_->pause();  // by escape
  const WindowInput& input = routed.player;
  shows_players_ = input.shows_players;
  // Otherwise the script or the benchmark moves the player.
  if (!runner_ && !benchmark_) move_player(input, std::min(seconds, 0.1));
  edit_with(input, now_us);
  if (input.scroll != 0) {
    if (input.resizes) {
      tool_.box().change_size(input.scroll);
    } else {
      hud_.scroll(input.scroll);
    }
  }
  for (const Action action : input.actions) act(action, now_us);
  if (!routed.for_ui.empty()) {
    hud_.feed(routed.for_ui);
    // The interface takes the events now, so that it knows before the next ones whether it types.
    static_cast<void>(hud_.make_frame(hud_scene(), now_us));
  }
  input_.set_window_open(hud_.focus().has_window);
  if (window_) window_->set_captured(input_.is_captured());
  if (!routed.for_ui.empty() || !input.actions.empty() || input.scroll != 0) pipeline_.moved();
}

bool Client::is_scene_moving(TimeUs now_us) {
  const Pose pose = player_.pose();
  const bool has_moved = std::exchange(drawn_pose_, pose) != pose;
  const auto& others = session_.others();
  bool have_moved = poses_.size() != others.size();
  poses_.resize(others.size());
  std::size_t i = 0;
  for (const auto& [author, other] : others) {
    std::optional<Pose>& known = poses_[i++];
    have_moved = have_moved || known != other.pose;
    known = other.pose;
  }
  if (have_moved) posed_us_ = now_us;
  return has_moved || now_us - posed_us_ < kPoseUs || hud_.is_moving();
}

void Client::wake_display(TimeUs now_us) {
  if (!window_) return;
  const bool has_focus = window_->has_focus();
  pipeline_.set_frame_interval(has_focus ? MeshPipeline::kFrameUs : kBackgroundFrameUs);
  const TimeUs idle_us = has_focus ? kStillFrameUs : kStillFrameUsBackground;
  if (is_scene_moving(now_us) || now_us - drawn_us_ >= idle_us) pipeline_.moved();
}

void Client::act(Action action, TimeUs now_us) {
  if (hud_.act(action)) return;
  if (const auto done = act_on_tool(tool_, action, now_us)) {
    hud_.notify(*done ? **done : done->error(),
                *done ? NoticeKind::information : NoticeKind::warning);
    return;
  }
  switch (action) {
    case Action::release:
      if (menu_ != nullptr) return menu_->pause();
      end_requested_ = true;
      return;
    case Action::walk_or_fly:
      return player_.set_walking(!player_.is_walking());
    case Action::undo:
      return chat_.send("/undo");  // the answer is shown
    case Action::redo:
      return chat_.send("/redo");
    case Action::earlier:
      return scrub(-1);
    case Action::later:
      return scrub(1);
    case Action::live:
      return static_cast<void>(session_.request_history({}));
    case Action::screenshot:
      return take_picture();
    case Action::ground:
      shows_ground_ = !shows_ground_;
      return;
    default:
      return;
  }
}

void Client::edit_with(const WindowInput& input, TimeUs now_us) {
  const auto note = [&](const Result<void, std::string>& done) {
    if (!done) hud_.notify(done.error(), NoticeKind::warning);
  };
  const bool repeats = tool_.repeats();
  int acts = remove_button_.acts(input.remove_clicks, input.remove_held && repeats, now_us);
  while (acts-- > 0) note(tool_.press(ToolButton::clear, now_us));
  acts = place_button_.acts(input.place_clicks, input.place_held && repeats, now_us);
  while (acts-- > 0) note(tool_.press(ToolButton::place, now_us));
  if (input.remove_held || input.place_held) {
    tool_.drag();
  } else if (!runner_ || input.remove_clicks + input.place_clicks != 0) {
    note(tool_.release(now_us));
  }
  if (input.pick_clicks == 0) return;
  if (const auto hit = tool_.pick()) hud_.hold(hit->material);
}

void Client::take_picture() {
  const TimeUs utc_us = actions_.utc_now_us();
  const std::string file = fmt::format("runstone-{:%Y-%m-%d-%H%M%S}-{:03}.png",
                                       fmt::gmtime(utc_us / 1'000'000), utc_us / 1'000 % 1'000);
  if (actions_.screenshot(file)) hud_.notify("picture: " + actions_.screenshot_path(file));
}

void Client::move_player(const WindowInput& input, double seconds) {
  WindowInput turned = input;
  turned.look_dx *= settings().sensitivity;
  turned.look_dy *= settings().sensitivity * (settings().invert_y ? -1 : 1);
  player_.turn(turned);
  if (!player_.is_walking()) return player_.fly(input, seconds);
  const Replica& replica = session_.replica();
  if (!replica.opened()) return;
  player_.walk(input, seconds, ShownSpace(replica), body_materials_);
}

void Client::scrub(int steps) {
  const Sequence newest = session_.replica().newest();
  Sequence from = newest;
  if (session_.loading_history()) {
    const HistoryRequest& under_way = session_.history_request();
    if (under_way.to == HistoryTarget::sequence) from = under_way.seq;
  } else if (session_.replica().past()) {
    from = session_.replica().past()->seq;
  }
  const auto step = static_cast<std::int64_t>(std::max<Sequence>(1, newest / kScrubSteps));
  const auto to = static_cast<Sequence>(
      std::max<std::int64_t>(0, static_cast<std::int64_t>(from) + steps * step));
  HistoryRequest request;  // the live world
  if (to < newest) {
    request.to = HistoryTarget::sequence;
    request.seq = to;
  }
  static_cast<void>(session_.request_history(request));
}

void Client::follow_player(TimeUs now_us) {
  if (view_.follow(now_us)) pipeline_.view_changed();
  if (!session_.replica().opened()) return;
  pipeline_.joined(session_.view(), started_us_);
  pipeline_.set_eye(player_.chunk(session_.replica().chunk_edge()));
}

MemoryUse Client::memory_use() const {
  return {session_.replica().chunk_bytes(), session_.replica().local_edits().bytes(),
          pipeline_.mesh_bytes(), pipeline_.gpu_bytes()};
}

void Client::limit_memory(TimeUs now_us) {
  const MemoryUse use = memory_use();
  const ViewRadii before = budget_.radii();
  const auto complete_since_us = view_.complete_since_us();
  const bool is_meshed = complete_since_us && now_us - *complete_since_us >= kMeshedUs;
  if (budget_.step(use, is_meshed, now_us)) {
    const ViewRadii radii = budget_.radii();
    const bool has_shrunk = radii.h + radii.v < before.h + before.v;
    spdlog::log(has_shrunk ? spdlog::level::warn : spdlog::level::info,
                "memory: {} of {} MiB in use; the view {} to radius {} of {} chunks, {} of {} "
                "vertically",
                use.total() >> 20, budget_.bytes_max() >> 20, has_shrunk ? "shrinks" : "grows",
                radii.h, budget_.wanted().h, radii.v, budget_.wanted().v);
    view_.set_radii(radii);
    pipeline_.view_changed();
    drain_changes();
  }
  const MemoryUse kept = memory_use();
  pipeline_.set_mesh_bytes_max(budget_.room(kept) + kept.meshes + kept.gpu);
}

void Client::drain_changes() {
  const ReplicaChanges changes = session_.replica().drain_changes();
  pipeline_.take(changes, session_.clock(), steady_now_us());
  for (const auto& [key, reason] : changes.unavailable) {
    spdlog::warn("chunk={} unavailable: {}", text_of(key), to_string(reason));
  }
  if (session_.history_refusal() != logged_refusal_) {
    logged_refusal_ = session_.history_refusal();
    if (!logged_refusal_.empty()) {
      spdlog::warn("the past is not shown: {}", logged_refusal_);
      hud_.notify("the past is not shown: " + logged_refusal_, NoticeKind::warning);
    }
  }
  const bool is_read_only = session_.is_server_read_only();
  if (std::exchange(logged_read_only_, is_read_only) != is_read_only) {
    const char* const news = is_read_only ? "the server is read-only: its disk is full"
                                          : "the server accepts edits again";
    spdlog::warn("{}", news);
    hud_.notify(news, is_read_only ? NoticeKind::warning : NoticeKind::information);
  }
  for (const RejectedEdit& reject : changes.rejects) {
    spdlog::info("edit={} rejected: {} {}", reject.seq, to_string(reject.reason), reject.detail);
    hud_.notify(
        fmt::format("the server refused an edit: {} {}", to_string(reject.reason), reject.detail),
        NoticeKind::warning);
  }
}

void Client::log_players(TimeUs now_us) {
  if (now_us - players_logged_us_ < kPlayerLogUs) return;
  players_logged_us_ = now_us;
  player_log_.update(session_.others());
}

void Client::add_ground(std::vector<Marker>& markers) const {
  const Replica& replica = session_.replica();
  if (!shows_ground_ || replica.past()) return;
  for (const auto& [seq, box] : replica.ground().boxes()) {
    if (const auto outline = ground_marker(box, player_.eye(), draw_distance()))
      markers.push_back(*outline);
  }
}

double Client::draw_distance() const {
  return (view_.radii().h + 1.5) * std::max(16, session_.replica().chunk_edge());
}

FrameContents Client::contents() const {
  FrameContents out;
  for (const auto& [author, other] : session_.others()) {
    if (!other.pose) continue;
    if (const auto body = player_body(author, *other.pose, player_.eye()))
      out.bodies.push_back(*body);
  }
  out.markers = markers();
  const std::span<const GhostChunk> ghosts = tool_.ghosts();
  out.ghosts.assign(ghosts.begin(), ghosts.end());
  return out;
}

std::vector<Marker> Client::markers() const {
  std::vector<Marker> out;
  add_ground(out);
  if (const auto hit = options_.headless ? std::nullopt : tool_.pick()) {
    const auto at = [](std::int32_t v) { return v - 0.002; };
    out.push_back({at(hit->voxel.x), at(hit->voxel.y), at(hit->voxel.z), 1.004, 1.004, 1.004, 20,
                   20, 20, false});
  }
  add_selection(out);
  return out;
}

void Client::add_selection(std::vector<Marker>& markers) const {
  const auto outline = [&](const VoxelBox& box, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
    constexpr double kGap = 0.01;
    markers.push_back({box.min.x - kGap, box.min.y - kGap, box.min.z - kGap,
                       box.max.x - box.min.x + 2 * kGap, box.max.y - box.min.y + 2 * kGap,
                       box.max.z - box.min.z + 2 * kGap, r, g, b, false});
  };
  if (const auto& selection = tool_.box().selection()) outline(*selection, 60, 160, 255);
  for (const VoxelPos at : tool_.box().points()) outline(box_between(at, at), 255, 200, 60);
}

std::array<int, 2> Client::frame_size() const {
  return window_ ? window_->framebuffer_size() : std::array{options_.width, options_.height};
}

void Client::use_quality() {
  if (menu_ == nullptr || !menu_->settings() || options_.given.quality) return;
  const auto quality = quality_of(settings());
  if (quality != pipeline_.look().quality()) pipeline_.look().set_quality(quality);
}

const ClientSettings& Client::settings() const {
  const bool is_changed = menu_ != nullptr && menu_->settings();
  return is_changed ? *menu_->settings() : options_.settings;
}

Camera Client::camera() const {
  Camera out = player_.camera(draw_distance());
  // Pictures of scripts do not depend on settings.
  if (window_ != nullptr) out.fov_y = settings().field_of_view * std::numbers::pi / 180;
  return out;
}

HudScene Client::hud_scene() const {
  HudScene scene;
  scene.is_captured = !window_ || input_.is_captured();
  scene.is_connected = network_.is_connected();
  scene.shows_players = shows_players_;
  if (const auto hit = tool_.pick()) scene.aimed_at = hit->material;
  scene.state = moment_text(session_.replica().past());
  if (const std::string lost = lost_text(steady_now_us()); !lost.empty()) scene.state = lost;
  if (scene.state.empty()) scene.state = memory_text(budget_);
  scene.tool = tool_.text();
  if (hud_.shows_statistics()) {
    scene.net = network_.net_counts();
    scene.memory = memory_use();
    scene.memory_max = budget_.bytes_max();
  }
  scene.camera = camera();
  scene.size = frame_size();
  return scene;
}

void Client::draw(TimeUs now_us) {
  wake_display(now_us);
  if (!pipeline_.is_frame_due(now_us)) return;
  drawn_us_ = now_us;
  const std::array<int, 2> size = frame_size();
  FrameOrder order;
  order.camera = camera();
  order.width = size[0];
  order.height = size[1];
  use_quality();
  order.contents = contents();
  const bool has_menu = menu_ != nullptr && menu_->is_open();
  order.overlay = has_menu
                      ? menu_->make_frame(connecting_state(now_us), pause_state(), size, now_us)
                      : hud_.make_frame(hud_scene(), now_us);
  pipeline_.draw(now_us, std::move(order));
}

bool Client::feed_menu(const WindowEvents& events) {
  if (menu_ == nullptr || !menu_->is_open()) return false;
  menu_->feed(events.events);
  pipeline_.moved();
  return true;
}

void Client::step_menu(TimeUs now_us) {
  if (menu_ == nullptr) return;
  if (menu_->is_connecting() && opened_us_) {
    const bool has_ground = session_.is_open() && pipeline_.meshed_count() >= kGroundChunks;
    if (has_ground || view_.is_complete() || now_us - *opened_us_ > kGroundWaitUs) {
      menu_->set_joined();
      spdlog::info("ground in view ms={}", (now_us - started_us_) / 1'000);
    }
  }
  if (menu_->take_resumed()) input_.capture();
  const auto choice = menu_->choice();
  if (!choice) return;
  end_requested_ = true;
  is_left_ = *choice == PlayChoice::leave;
}

ConnectingState Client::connecting_state(TimeUs now_us) const {
  ConnectingState out;
  if (opened_us_) {
    const std::size_t all = session_.is_open() ? session_.view_chunks() : 0;
    const std::size_t here = std::min(session_.replica().current_count(), all);
    out.step = fmt::format("receiving the world: {} of {} chunks", here, all);
    if (all != 0) out.progress = static_cast<double>(here) / static_cast<double>(all);
    return out;
  }
  switch (session_.state()) {
    case SessionState::offline:
      out.step = options_.tls ? "connecting, encrypted" : "connecting";
      break;
    case SessionState::hello_sent:
      out.step = "greeting the server";
      break;
    default:
      out.step = "showing the key to the server";
      break;
  }
  const FailureWords words = network_.failure_words();
  if (words.headline.empty()) return out;
  out.detail = fmt::format("{}. Trying again for {:.0f} s.\n{}", words.headline,
                           network_.seconds_left(now_us), words.detail);
  return out;
}

PauseState Client::pause_state() const {
  PauseState out;
  const std::size_t others = session_.others().size();
  if (others != 0)
    out.players =
        others == 1 ? "one other player is here" : fmt::format("{} others are here", others);
  return out;
}

std::string Client::lost_text(TimeUs now_us) const {
  if (network_.is_connected() || !opened_us_) return {};
  const std::size_t waiting = session_.replica().local_edits().pending_count();
  std::string out = fmt::format("the server is gone: connecting again, {:.0f} s left",
                                network_.seconds_left(now_us));
  if (waiting != 0) out += fmt::format("; {} edits wait for it", waiting);
  return out;
}

FailureWords Client::failure_words() const {
  FailureWords words = network_.failure_words();
  const std::size_t waiting = session_.replica().local_edits().pending_count();
  if (waiting == 0) return words;
  if (!words.detail.empty()) words.detail += "\n";
  words.detail += fmt::format("{} of your edits were not confirmed, and may be lost.", waiting);
  return words;
}

std::optional<ClientEnd> Client::end_of_play(TimeUs now_us) {
  if (const auto refusal = network_.refusal())
    return ClientEnd{kExitNoStart, false, *refusal, failure_words(), session_.lacks_password()};
  if (runner_ && runner_->finished() && pipeline_.screenshots_done() && pipeline_.has_caught_up())
    return ClientEnd{runner_->failures().empty() && !drift_found() ? kExitOk : kExitFailed};
  if (benchmark_ && benchmark_->finished() && !runner_) return ClientEnd{kExitOk};
  const bool has_goodbye = session_.end() && session_.end()->by_server;
  if (end_requested_ || (has_goodbye && options_.exit_on_goodbye))
    return ClientEnd{drift_found() ? kExitFailed : kExitOk, is_left_};
  if (const auto timeout = network_.timeout(now_us))
    return ClientEnd{kExitNoStart, false, *timeout, failure_words()};
  return std::nullopt;
}

void Client::rest(TimeUs now_us) {
  if (network_.has_events()) return;
  TimeUs pause = kRestUs;
  if (window_) pause = window_->has_focus() ? kRestUsWindow : kRestUsBackground;
  if (runner_ && runner_->due_us()) pause = std::min(pause, *runner_->due_us() - now_us);
  if (pause > 0) wake_.wait(std::chrono::microseconds(pause));
}

ClientReport Client::report() const {
  ClientReport out;
  out.renderer = pipeline_.renderer_name();
  out.seconds = static_cast<double>(steady_now_us() - started_us_) / 1e6;
  out.latency = pipeline_.recorder().report();
  out.join = pipeline_.join();
  out.edits_refused = tool_.refused();
  out.memory = memory_use();
  out.budget = {budget_.bytes_max(), budget_.peak_bytes(), budget_.shrinks(),
                budget_.growths(),   budget_.radii(),      budget_.wanted()};
  network_.add_to(out);
  pipeline_.add_to(out);
  return out;
}

int Client::finish(int code) {
  network_.finish();
  if (runner_) {
    for (const std::string& failure : runner_->failures())
      std::fprintf(stderr, "%s\n", failure.c_str());
  }
  if (benchmark_ && benchmark_->finished()) {
    std::fputs(benchmark_->table(pipeline_.renderer_name(), pipeline_.look().name()).c_str(),
               stdout);
  }
  const ClientReport measured = report();
  const auto require = [&code](const Result<void, std::string>& written) {
    if (written) return;
    std::fprintf(stderr, "runstone-client: %s\n", written.error().c_str());
    code = std::max(code, kExitFailed);
  };
  if (!options_.report.empty())
    require(write_output_file(options_.report, to_json(measured, session_)));
  if (!options_.digests.empty()) require(write_digests(options_.digests, session_));
  if (session_.connect_count() != 0) std::fputs(to_table(measured, session_).c_str(), stdout);
  spdlog::info("exit code={}", code);
  return code;
}

}  // namespace runstone
