#include "client/app/client.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <span>
#include <utility>

#include "client/app/connection_words.hpp"
#include "client/app/player_defaults.hpp"
#include "client/play/time_travel.hpp"
#include "client/report/exit_code.hpp"
#include "common/os/output_file.hpp"
#include "common/os/steady_clock.hpp"
#include "protocol/codec/view_tiles.hpp"

namespace runstone {
namespace {

/// The longest pause of the loop. The session needs a tick at least this often.
constexpr TimeUs kRestUs = 10'000;
/// The longest pause of the loop with a window. A key or a click waits no longer than this.
constexpr TimeUs kRestUsWindow = 2'000;
/// The longest pause of the loop with a window that has no focus.
constexpr TimeUs kRestUsBackground = 10'000;
constexpr TimeUs kHorizonLookUs = 20'000;  // between two looks at the distant ground
constexpr TimeUs kPlayerLogUs = 1'000'000;
/// The connecting screen ends with this many meshed chunks, or this long after the world opened.
constexpr std::uint64_t kGroundChunks = 27;
constexpr TimeUs kGroundWaitUs = 3'000'000;
/// Returns the terminal in which a person may type, or nullopt if there is none or a script plays.
std::optional<int> terminal_of(const Script* script) {
  if (script != nullptr || ::isatty(STDIN_FILENO) != 1) return std::nullopt;
  return STDIN_FILENO;
}

Driver driver_of(const ClientOptions& options, const Script* script) {
  if (script != nullptr) return Driver::script;
  return options.benchmark ? Driver::benchmark : Driver::person;
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
      wake_(display.wake),
      network_(options_, [this] { wake_.notify(); }),
      session_(network_.session()),
      window_(display.window.get()),
      menu_(menu),
      pipeline_(session_.replica(), display.draw_thread.get(), window_ != nullptr, options_.workers,
                [this] { wake_.notify(); }),
      tool_(session_, player_, pipeline_.recorder(), display.tools,
            [](const std::string& why) { spdlog::warn("edit refused: {}", why); }),
      previews_(session_, tool_),
      input_(router_of(options_.settings)),
      view_(session_, player_, {options_.view_radius, options_.view_radius_v}, options_.far_levels),
      limits_({options_.memory_mib != 0 ? options_.memory_mib : automatic_memory_mib(),
               {options_.view_radius, options_.view_radius_v},
               options_.far_levels},
              session_.replica(), pipeline_, view_),
      chat_(session_, terminal_of(script)),
      panels_(session_, player_, tool_.box()),
      hud_(session_, player_, pipeline_, chat_, panels_, tool_, options_.name, input_.keys(),
           options_.settings.interface_scale),
      actions_(session_, player_, pipeline_, tool_, view_, chat_, input_, hud_, panels_,
               options_.screenshot_dir),
      controls_(session_, player_, tool_, pipeline_, hud_, chat_, actions_,
                driver_of(options_, script)),
      scene_(session_, player_, tool_, view_),
      notices_(session_, hud_) {
  controls_.show_ground(options_.show_protected);
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
    if (panels_.step(hud_.shown_panels(), now_us)) pipeline_.moved();
    limit_memory(now_us);
    limit_far_memory(now_us);
    if (now_us >= horizon_due_us_) look_at_horizon(now_us);
    poll_window();
    handle_input(now_us);
    step_menu(now_us);
    pipeline_.take_drawn();
    for (const std::string& file : pipeline_.take_unwritten())
      spdlog::warn("screenshot={} cannot be written", file);
    log_players(now_us);
    chat_.step();
    if (hud_.take_chat()) pipeline_.moved();
    view_.update_completeness(now_us);
    if (runner_) runner_->step(now_us);
    if (benchmark_ && session_.is_open()) benchmark_->step(player_, pipeline_, view_);
    flush();  // local edits go first, because following the player may take long
    follow_player(now_us);
    network_.step_cache(now_us, limits_.room());  // the view names the chunks that were found
    session_.tick(now_us);
    flush();
    if (tool_.step_preview()) pipeline_.moved();
    if (previews_.step(settings(), now_us)) pipeline_.moved();
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
  controls_.set_materials(welcome.materials);
  if (std::exchange(world_, welcome.world_id) != welcome.world_id) hud_.enter(welcome.materials);
  set_tool_materials(welcome.materials);
  if (std::max(options_.view_radius, options_.view_radius_v) > welcome.view_radius_max) {
    spdlog::warn(
        "this server allows a view radius of {} chunks: the view of {} and {} is cut to it",
        welcome.view_radius_max, options_.view_radius, options_.view_radius_v);
  }
  if (welcome.tile_levels_max < options_.far_levels) {
    spdlog::warn("this server allows {} levels of far ground: the {} levels are cut to it",
                 welcome.tile_levels_max, options_.far_levels);
  }
  if (options_.far_levels != 0 && options_.view_radius < kTileRadiusHMin)
    spdlog::warn("far ground needs a view radius of {} chunks or more", kTileRadiusHMin);
  limits_.open_world(welcome.view_radius_max);
}

void Client::take_new_materials() {
  const auto& welcome = session_.welcome();
  const std::size_t known = pipeline_.materials().size();
  if (!session_.is_open() || welcome->materials.size() <= known) return;
  pipeline_.set_materials(welcome->materials);
  controls_.set_materials(welcome->materials);
  set_tool_materials(welcome->materials);
  spdlog::info("the world has {} new materials", welcome->materials.size() - known);
}

void Client::set_tool_materials(const MaterialTable& materials) {
  panels_.set_materials(materials);
  previews_.set_materials(materials);
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
  // By escape. Beside a window it only frees the mouse.
  const bool is_freed = was_captured && !input_.is_captured();
  if (menu_ != nullptr && is_freed && hud_.focus().panels == 0) pause();
  controls_.take(routed.player, std::min(seconds, 0.1), settings(), now_us);
  if (controls_.take_release()) {
    if (menu_ != nullptr) {
      pause();
    } else {
      end_requested_ = true;
    }
  }
  if (!routed.for_ui.empty()) {
    hud_.feed(routed.for_ui);
    // The interface takes the events now, so that it knows before the next ones whether it types.
    static_cast<void>(hud_.make_frame(hud_scene(), now_us));
  }
  const UiFocus focus = hud_.focus();
  input_.set_windows(focus.has_window, focus.panels);
  if (window_) window_->set_captured(input_.is_captured());
  if (!routed.for_ui.empty()) pipeline_.moved();
}

void Client::pause() {
  input_.release();
  menu_->pause();
  // The menu gets the events that came after escape in the same turn.
  menu_->feed(input_.take_waiting());
}

void Client::follow_player(TimeUs now_us) {
  if (view_.follow(now_us)) pipeline_.view_changed();
  if (!session_.replica().opened()) return;
  pipeline_.joined(session_.view(), started_us_);
  pipeline_.set_eye(player_.chunk(session_.replica().chunk_edge()));
}

void Client::limit_memory(TimeUs now_us) {
  const MemoryUse use = limits_.use();
  const ViewRadii before = limits_.budget().radii();
  if (limits_.limit_view(now_us)) {
    const ViewRadii radii = limits_.budget().radii(), wanted = limits_.budget().wanted();
    const bool has_shrunk = radii.h + radii.v < before.h + before.v;
    spdlog::log(has_shrunk ? spdlog::level::warn : spdlog::level::info,
                "memory: {} of {} MiB in use; the view {} to radius {} of {} chunks, {} of {} "
                "vertically",
                use.total() >> 20, limits_.budget().bytes_max() >> 20,
                has_shrunk ? "shrinks" : "grows", radii.h, wanted.h, radii.v, wanted.v);
    drain_changes();
  }
  limits_.limit_meshes();
}

void Client::limit_far_memory(TimeUs now_us) {
  const std::size_t bytes = pipeline_.far_bytes();
  const std::uint8_t before = limits_.far().levels();
  if (!limits_.limit_far(now_us)) return;
  const FarBudget& far = limits_.far();
  const bool has_shrunk = far.levels() < before;
  spdlog::log(has_shrunk ? spdlog::level::warn : spdlog::level::info,
              "memory: {} of {} MiB in use by far ground, which {} to {} of {} levels", bytes >> 20,
              far.bytes_max() >> 20, has_shrunk ? "shrinks" : "grows", far.levels(), far.wanted());
  drain_changes();
}

void Client::look_at_horizon(TimeUs now_us) {
  if (!session_.replica().opened() || tile_levels(session_.view()) == 0) return;
  horizon_due_us_ = now_us + kHorizonLookUs;
  horizon_.begin(started_us_);
  if (horizon_.is_open())
    horizon_.look(session_.replica().far_tiles(), pipeline_.is_far_meshed(), now_us);
}

void Client::drain_changes() {
  const ReplicaChanges changes = session_.replica().drain_changes();
  pipeline_.take(changes, session_.clock(), steady_now_us());
  panels_.take(changes);
  notices_.take(changes);
}

void Client::log_players(TimeUs now_us) {
  if (now_us - players_logged_us_ < kPlayerLogUs) return;
  players_logged_us_ = now_us;
  player_log_.update(session_.others());
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
  // Pictures of scripts do not depend on settings.
  return scene_.camera(window_ != nullptr ? std::optional(settings().field_of_view) : std::nullopt);
}

HudScene Client::hud_scene() const {
  HudScene scene;
  scene.is_captured = !window_ || input_.is_captured();
  scene.is_connected = network_.is_connected();
  scene.shows_players = controls_.shows_players();
  scene.sight = tool_.pick();
  scene.state = moment_text(session_.replica().past());
  const std::string lost = opened_us_ ? lost_text(network_, steady_now_us()) : std::string();
  if (!lost.empty()) scene.state = lost;
  if (scene.state.empty()) scene.state = limits_.text();
  if (scene.state.empty() && player_.is_waiting_for_ground())
    scene.state = "the ground here has not arrived yet";
  scene.tool = tool_.text();
  if (hud_.shows_statistics()) {
    scene.net = network_.net_counts();
    scene.memory = limits_.use();
    scene.memory_max = limits_.budget().bytes_max();
    scene.far_bytes_max = limits_.far().bytes_max();
    scene.reach = scene_.reach();
  }
  scene.camera = camera();
  scene.size = frame_size();
  return scene;
}

void Client::draw(TimeUs now_us) {
  if (window_) {
    const bool is_moving = panels_.take_moved(now_us) || hud_.is_moving();
    pace_.step(pipeline_, window_->has_focus(), player_.pose(), is_moving, now_us);
  }
  if (!pipeline_.is_frame_due(now_us)) return;
  pace_.drew(now_us);
  const std::array<int, 2> size = frame_size();
  FrameOrder order;
  order.camera = camera();
  order.width = size[0];
  order.height = size[1];
  use_quality();
  order.contents = scene_.contents(panels_.poses(), !options_.headless, controls_.shows_ground());
  const std::span<const GhostChunk> rollback = panels_.rollback().ghosts();
  order.contents.ghosts.insert(order.contents.ghosts.end(), rollback.begin(), rollback.end());
  previews_.append_ghosts(order.contents.ghosts);
  const bool has_menu = menu_ != nullptr && menu_->is_open();
  order.overlay = has_menu ? menu_->make_frame(connecting_state(network_, opened_us_.has_value(),
                                                                options_.tls.has_value(), now_us),
                                               pause_state(session_), size, now_us)
                           : hud_.make_frame(hud_scene(), now_us);
  pipeline_.draw(now_us, std::move(order));
}

bool Client::feed_menu(const WindowEvents& events) {
  if (menu_ == nullptr || !menu_->is_open()) return false;
  input_.release_all();  // the menu sees the releases of the keys that were held
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

std::optional<ClientEnd> Client::end_of_play(TimeUs now_us) {
  if (const auto refusal = network_.refusal())
    return ClientEnd{kExitNoStart, false, *refusal, failure_words(network_),
                     session_.lacks_password()};
  if (runner_ && runner_->finished() && pipeline_.screenshots_done() && pipeline_.has_caught_up())
    return ClientEnd{runner_->failures().empty() && !drift_found() ? kExitOk : kExitFailed};
  if (benchmark_ && benchmark_->finished() && !runner_) return ClientEnd{kExitOk};
  const bool has_goodbye = session_.end() && session_.end()->by_server;
  if (end_requested_ || (has_goodbye && options_.exit_on_goodbye))
    return ClientEnd{drift_found() ? kExitFailed : kExitOk, is_left_, {}, leaving_words(network_)};
  if (const auto timeout = network_.timeout(now_us))
    return ClientEnd{kExitNoStart, false, *timeout, failure_words(network_)};
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
  out.seconds = static_cast<double>(steady_now_us() - started_us_) / 1e6;
  out.edits_refused = tool_.refused();
  limits_.add_to(out, session_.view(), scene_.reach());
  out.far.horizon = horizon_.report();
  network_.add_to(out);
  pipeline_.add_to(out);
  return out;
}

int Client::finish(int code) {
  look_at_horizon(steady_now_us());
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
