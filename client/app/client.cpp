#include "client/app/client.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <utility>

#include "client/app/connection_words.hpp"
#include "client/app/player_defaults.hpp"
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
/// The connecting screen ends this long after the world opened, if there is no ground before.
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

KeyMap keys_of(const ClientSettings& settings) {
  std::vector<std::string> warnings;
  KeyMap out = key_map_of(settings, warnings);
  for (const std::string& warning : warnings) spdlog::warn("{}", warning);
  return out;
}

PlayConfig play_config(const ClientOptions& options, const Script* script, bool is_watched,
                       const PlayerFiles& files) {
  PlayConfig out;
  out.wishes = {options.memory_mib != 0 ? options.memory_mib : automatic_memory_mib(),
                {options.view_radius, options.view_radius_v},
                options.far_levels};
  out.driver = driver_of(options, script);
  out.keys = keys_of(options.settings);
  out.walks = options.settings.walks;
  out.is_watched = is_watched;
  out.workers = options.workers;
  out.started_us = steady_now_us();
  out.time_of_day = options.time_of_day;
  out.kit_of = [&files](const WorldId& world) { return files.kit_of(world); };
  out.hotbars = load_hotbars(options.hotbars_file);
  return out;
}

}  // namespace

Client::Client(ClientOptions options, const Script* script, ClientDisplay& display, GameMenu* menu)
    : options_(std::move(options)),
      wake_(display.wake),
      network_(options_, [this] { wake_.notify(); }),
      session_(network_.session()),
      clipboard_(display.clipboard.get()),
      window_(display.window.get()),
      menu_(menu),
      player_files_(options_.kits_file, options_.hotbars_file),
      play_(session_, display.tools, display.draw_thread.get(), log_,
            play_config(options_, script, window_ != nullptr, player_files_),
            [this] { wake_.notify(); }),
      pipeline_(play_.pipeline()),
      chat_(play_.chat(), terminal_of(script)),
      hud_(play_, options_.name, options_.settings.interface_scale),
      actions_(play_, chat_, hud_, options_.screenshot_dir),
      shows_ground_(options_.show_protected) {
  hud_.set_shown(window_ != nullptr);
  play_.tool().box().show_preview(window_ != nullptr);
  if (script != nullptr) runner_.emplace(*script, actions_);
  if (options_.benchmark) benchmark_.emplace(*options_.benchmark);
  pipeline_.look().set_quality(options_.quality);
  pipeline_.look().set_antialiasing(options_.antialiasing);
  network_.start(play_.started_us());
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
    const bool is_opened = network_.take_world_opened();
    if (is_opened) check_view();
    const TimeUs now_us = steady_now_us();
    // Changes are passed on before the script asks whether all of them are drawn.
    play_.begin_turn(is_opened, hud_.shown_panels(), now_us);
    if (now_us >= horizon_due_us_) look_at_horizon(now_us);
    poll_window();
    handle_input(now_us);
    step_menu(now_us);
    pipeline_.take_drawn();
    log_antialiasing();
    for (const std::string& failed : pipeline_.take_unwritten()) {
      spdlog::warn("no screenshot: {}", failed);
      hud_.notify("no picture: " + failed);
    }
    log_.log_players(session_.others(), now_us);
    step_files(now_us);
    keep_player(now_us);
    if (const std::string warning = player_files_.step(now_us); !warning.empty())
      spdlog::warn("{}", warning);
    show_news();
    if (runner_) runner_->step(now_us);
    if (benchmark_ && session_.is_open()) benchmark_->step(play_.player(), pipeline_, play_.view());
    flush();  // local edits go first, because following the player may take long
    play_.follow(now_us);
    // The view names the chunks that were found.
    network_.step_cache(now_us, play_.limits().room());
    play_.step_textures(play_settings(), now_us);
    session_.tick(now_us);
    flush();
    play_.step_previews(play_settings(), now_us);
    play_.step_author(play_settings(), now_us);
    draw(now_us);
    if (stop != 0) end_requested_ = true;
    end = end_of_play(steady_now_us());
    if (!end) rest(steady_now_us());
  }
  return *end;
}

void Client::check_view() const {
  const Welcome& welcome = *session_.welcome();
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
}

void Client::flush() {
  network_.flush();
  play_.take_changes(steady_now_us());
  pipeline_.mesh();
}

void Client::show_news() {
  for (ShownLine& line : chat_.step()) {
    hud_.hear(std::move(line));
    pipeline_.moved();
  }
  if (const auto withdrawn = play_.chat().take_withdrawn(); !withdrawn.empty()) {
    hud_.withdraw(withdrawn);
    pipeline_.moved();
  }
  for (PlayerNotice& notice : play_.take_notices())
    hud_.notify(std::move(notice.text), notice.kind);
  if (clipboard_ == nullptr) return;
  if (std::string failed = clipboard_->step(play_.tool().box()); !failed.empty())
    hud_.notify(std::move(failed));
}

void Client::poll_window() {
  if (!window_) return;
  const WindowEvents polled = window_->poll();
  if (polled.close) end_requested_ = true;
  for (const std::string& file : polled.dropped) dropped_.push_back(hud_.drop(file));
  if (feed_menu(polled)) return;
  if (!runner_) return play_.input().push(polled.events);
  // A script plays. Of the keyboard only escape counts.
  for (const InputEvent& event : polled.events) {
    const auto* const key = std::get_if<KeyEvent>(&event);
    if (key != nullptr && key->is_pressed && key->key == Key::escape) end_requested_ = true;
  }
}

void Client::step_files(TimeUs now_us) {
  ToolBox& tools = play_.tool().box();
  std::vector<ClipboardOfFile> wanted = hud_.take_files();
  if (hud_.take_file_stop()) files_.stop();
  for (ClipboardOfFile& file : std::exchange(dropped_, {})) wanted.push_back(std::move(file));
  for (const ClipboardOfFile& file : wanted) {
    if (auto notice = files_.begin(file, tools)) hud_.notify(std::move(notice->text), notice->kind);
  }
  if (auto notice = files_.step(tools)) hud_.notify(std::move(notice->text), notice->kind);
  if (!wanted.empty() || files_.is_busy()) pipeline_.moved();
  // The player sees the ghost of the build, and clicks where it is to stand.
  if (files_.take_loaded()) static_cast<void>(play_.tool().carry_out(ToolChoice{"paste"}, now_us));
}

void Client::handle_input(TimeUs now_us) {
  InputRouter& input = play_.input();
  const UiFocus before = hud_.focus();
  const bool was_captured = input.is_captured();
  const RoutedInput routed = play_.handle_input(before, play_settings(), now_us);
  shows_players_ = routed.player.shows_players;
  // By escape. Beside a window it only frees the mouse.
  const bool is_freed = was_captured && !input.is_captured();
  if (menu_ != nullptr && is_freed && before.panels == 0) pause();
  for (const Action action : routed.player.actions) act(action, now_us);
  if (!routed.for_ui.empty()) {
    hud_.feed(routed.for_ui);
    // The interface takes the events now, so that it knows before the next ones whether it types.
    static_cast<void>(hud_.make_frame(hud_scene(), now_us));
  }
  const UiFocus focus = hud_.focus();
  input.set_windows(focus.has_window, focus.panels);
  if (window_) window_->set_captured(input.is_captured());
  if (!routed.for_ui.empty()) pipeline_.moved();
}

void Client::act(Action action, TimeUs now_us) {
  if (hud_.act(action) || play_.act(action, now_us)) return;
  if (action == Action::screenshot) take_picture();
  if (action == Action::ground) shows_ground_ = !shows_ground_;
  if (action != Action::release) return;
  if (menu_ != nullptr) {
    pause();
  } else {
    end_requested_ = true;
  }
}

void Client::take_picture() {
  const TimeUs utc_us = actions_.utc_now_us();
  const std::string file = fmt::format("runstone-{:%Y-%m-%d-%H%M%S}-{:03}.png",
                                       fmt::gmtime(utc_us / 1'000'000), utc_us / 1'000 % 1'000);
  if (actions_.screenshot(file)) hud_.notify("picture: " + actions_.screenshot_path(file));
}

void Client::pause() {
  play_.input().release();
  menu_->pause();
  // The menu gets the events that came after escape in the same turn.
  menu_->feed(play_.input().take_waiting());
}

void Client::keep_player(TimeUs now_us) {
  for (const KeptKit& kept : play_.take_kits()) player_files_.keep(kept.world, kept.kit, now_us);
  if (auto hotbars = play_.take_hotbars()) player_files_.keep(*std::move(hotbars), now_us);
}

void Client::look_at_horizon(TimeUs now_us) {
  if (!session_.replica().opened() || tile_levels(session_.view()) == 0) return;
  horizon_due_us_ = now_us + kHorizonLookUs;
  horizon_.begin(play_.started_us());
  if (horizon_.is_open())
    horizon_.look(session_.replica().far_tiles(), pipeline_.is_far_meshed(), now_us);
}

std::array<int, 2> Client::frame_size() const {
  return window_ ? window_->framebuffer_size() : std::array{options_.width, options_.height};
}

void Client::use_look() {
  if (menu_ == nullptr || !menu_->settings()) return;
  LookControl& look = pipeline_.look();
  if (!options_.given.antialiasing) look.set_antialiasing(settings().antialiasing);
  const auto quality = quality_of(settings());
  if (!options_.given.quality && quality != look.quality()) look.set_quality(quality);
}

void Client::log_antialiasing() {
  const auto& frames = pipeline_.recent_frames();
  if (has_logged_antialiasing_ || frames.empty()) return;
  if (!frames.back().stats.lacks_msaa) return;
  has_logged_antialiasing_ = true;
  spdlog::warn("the OpenGL driver has no MSAA: edges are smoothed by FXAA");
}

const ClientSettings& Client::settings() const {
  const bool is_changed = menu_ != nullptr && menu_->settings();
  return is_changed ? *menu_->settings() : options_.settings;
}

PlaySettings Client::play_settings() const {
  const ClientSettings& now = settings();
  return {{now.sensitivity, now.invert_y},
          now.shows_previews,
          now.shares_previews,
          now.shows_textures && !options_.no_textures,
          now.shows_authors && hud_.is_shown()};
}

std::optional<double> Client::field_of_view() const {
  return window_ != nullptr ? std::optional(settings().field_of_view) : std::nullopt;
}

HudScene Client::hud_scene() const {
  HudScene scene;
  scene.has_window = window_ != nullptr;
  scene.is_connected = network_.is_connected();
  scene.shows_players = shows_players_;
  if (play_.was_opened()) scene.state = lost_text(network_, steady_now_us());
  if (scene.state.empty()) scene.state = play_.state_text();
  if (hud_.shows_statistics()) scene.net = network_.net_counts();
  scene.file = files_.state();
  scene.camera = play_.scene().camera(field_of_view());
  scene.size = frame_size();
  return scene;
}

void Client::draw(TimeUs now_us) {
  if (window_) play_.keep_pace(window_->has_focus(), hud_.is_moving(), now_us);
  if (!pipeline_.is_frame_due(now_us)) return;
  use_look();
  FrameOrder order =
      play_.frame({field_of_view(), !options_.headless, shows_ground_, frame_size()}, now_us);
  const bool has_menu = menu_ != nullptr && menu_->is_open();
  order.overlay = has_menu ? menu_->make_frame(connecting_state(network_, play_.was_opened(),
                                                                options_.tls.has_value(), now_us),
                                               pause_state(session_), frame_size(), now_us)
                           : hud_.make_frame(hud_scene(), now_us);
  pipeline_.draw(now_us, std::move(order));
}

bool Client::feed_menu(const WindowEvents& events) {
  if (menu_ == nullptr || !menu_->is_open()) return false;
  play_.input().release_all();  // the menu sees the releases of the keys that were held
  menu_->feed(events.events);
  pipeline_.moved();
  return true;
}

void Client::step_menu(TimeUs now_us) {
  if (menu_ == nullptr) return;
  if (menu_->is_connecting() && play_.has_ground(kGroundWaitUs, now_us)) {
    menu_->set_joined();
    spdlog::info("ground in view ms={}", (now_us - play_.started_us()) / 1'000);
  }
  if (menu_->take_resumed()) play_.input().capture();
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
  play_.add_to(out, steady_now_us());
  out.far.horizon = horizon_.report();
  network_.add_to(out);
  return out;
}

int Client::finish(int code) {
  look_at_horizon(steady_now_us());
  keep_player(steady_now_us());
  if (const auto written = player_files_.finish(); !written) spdlog::warn("{}", written.error());
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
