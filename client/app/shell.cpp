#include "client/app/shell.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <exception>
#include <utility>

#include "client/app/client.hpp"
#include "client/app/game_menu.hpp"
#include "client/app/local_start.hpp"
#include "client/app/player_defaults.hpp"
#include "client/local/local_worlds.hpp"
#include "client/net/key_file.hpp"
#include "client/session/join_check.hpp"
#include "client/settings/hotbars_file.hpp"
#include "client/settings/recent_servers.hpp"
#include "client/settings/world_kits.hpp"
#include "common/os/steady_clock.hpp"
#include "protocol/codec/key_fingerprint.hpp"
#include "protocol/codec/server_link.hpp"

namespace runstone {
namespace {

constexpr const char* kFirstWorld = "home";
/// The least time between two frames, and the time between frames without input.
constexpr TimeUs kFrameUs = 16'000, kMenuIdleUs = 250'000;
constexpr std::chrono::milliseconds kPollMs{4};
/// A server on this computer that ended does not come back.
constexpr double kLocalReconnectSeconds = 3;
/// ImGui needs some frames after an input until all of it is laid out.
constexpr int kFramesAfterInput = 4;

TimeUs utc_now_us() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

std::string ago(TimeUs then_us) {
  const TimeUs minutes = (utc_now_us() - then_us) / 60'000'000;
  if (minutes < 1) return "just now";
  if (minutes < 60) return fmt::format("{} min ago", minutes);
  if (minutes < 48 * 60) return fmt::format("{} h ago", minutes / 60);
  return fmt::format("{:%Y-%m-%d}", fmt::gmtime(static_cast<std::time_t>(then_us / 1'000'000)));
}

}  // namespace

Shell::Shell(ClientOptions options, LoadedSettings loaded, std::string settings_file,
             ClientDisplay& display)
    : options_(std::move(options)),
      settings_(std::move(loaded.settings)),
      settings_file_(std::move(settings_file)),
      display_(display),
      menu_(std::make_unique<Menu>(settings_)) {
  options_.asks_at_terminal = false;
  if (options_.script.empty()) {
    options_.kits_file = default_kits_file();
    options_.hotbars_file = default_hotbars_file();
  }
  static_cast<void>(key_map_of(settings_, loaded.warnings));
  if (!loaded.warnings.empty()) {
    title_.failure.headline = "Some settings are not used";
    for (const std::string& warning : loaded.warnings) title_.failure.detail += warning + "\n";
  }
  if (options_.has_server) {
    next_ = Destination{options_, to_string(options_.server), {}};
    next_->options.servers_file = default_servers_file();
  } else if (!options_.local_world.empty()) {
    join_local(options_.local_world, options_.local_creation);
  }
}

int Shell::run(const volatile std::sig_atomic_t& stop) {
  while (stop == 0 && !quits_) {
    if (next_) {
      play(*std::exchange(next_, std::nullopt), stop);
    } else {
      show_title(stop);
    }
  }
  save_local();
  return exit_code_;
}

void Shell::turn(const MakeFrame& make_frame) {
  WindowEvents events = display_.window->poll();
  if (events.close) quits_ = true;
  if (!events.events.empty()) frames_wanted_ = kFramesAfterInput;
  menu_->feed(events.events);
  for (const DrawDone& done : display_.draw_thread->take_done()) {
    if (std::holds_alternative<FrameDone>(done)) is_frame_in_progress_ = false;
  }
  const TimeUs now_us = steady_now_us();
  const TimeUs pause_us = frames_wanted_ > 0 ? kFrameUs : kMenuIdleUs;
  if (!is_frame_in_progress_ && now_us - drawn_us_ >= pause_us) {
    const std::array<int, 2> size = display_.window->framebuffer_size();
    const double seconds = static_cast<double>(now_us - std::exchange(drawn_us_, now_us)) / 1e6;
    FrameOrder order;
    order.width = size[0];
    order.height = size[1];
    order.overlay = make_frame(size, seconds);
    display_.draw_thread->draw(std::move(order));
    is_frame_in_progress_ = true;
    if (frames_wanted_ > 0) --frames_wanted_;
  }
  display_.wake.wait(kPollMs);
}

void Shell::refresh() {
  const std::string password_of = std::move(title_.asks_password_of);
  ShownFailure failure = std::move(title_.failure);
  title_ = {};
  title_.asks_password_of = password_of;
  title_.failure = std::move(failure);
  const LoadedServers recent = load_recent_servers(default_servers_file());
  if (!recent.warning.empty()) spdlog::warn("{}", recent.warning);
  for (const RecentServer& server : recent.servers)
    title_.servers.push_back({server.address, server.name, ago(server.joined_us)});
  for (const LocalWorld& world : list_local_worlds(local_worlds_folder()))
    title_.worlds.push_back({world.name, ago(world.changed_us)});
  title_.first_world = kFirstWorld;
  title_.name = options_.name;
  title_.key_file = options_.key_file;
  try {
    title_.identity = key_fingerprint(load_or_create_key(options_.key_file).public_key);
  } catch (const std::exception& error) {
    title_.identity = "none";
    spdlog::warn("{}", error.what());
    if (title_.failure.headline.empty())
      title_.failure = {"The key file cannot be used", error.what()};
  }
}

void Shell::show_title(const volatile std::sig_atomic_t& stop) {
  display_.window->set_title("Runstone");
  display_.window->set_captured(false);
  menu_ = std::make_unique<Menu>(settings_);  // the size of text may have changed
  refresh();
  frames_wanted_ = kFramesAfterInput;
  while (stop == 0 && !quits_ && !next_) {
    turn([this](std::array<int, 2> size, double seconds) {
      return menu_->title(title_, size, seconds);
    });
    for (const MenuAction& action : menu_->take_actions()) carry_out(action);
    step_saving();
  }
}

void Shell::carry_out(const MenuAction& action) {
  if (const auto* join = std::get_if<JoinAddress>(&action)) join_address(*join);
  if (const auto* join = std::get_if<JoinLocalWorld>(&action); join && take_name(join->name))
    join_local(join->world, {});
  if (const auto* make = std::get_if<MakeLocalWorld>(&action); make && take_name(make->name))
    join_local(make->world, NewLocalWorld{make->generator, make->seed});
  if (const auto* password = std::get_if<GivePassword>(&action); password != nullptr && last_) {
    next_ = *last_;
    next_->options.password = password->password;
    title_.asks_password_of.clear();
  }
  if (std::holds_alternative<CancelJoin>(action)) title_.asks_password_of.clear();
  if (std::holds_alternative<QuitProgram>(action)) quits_ = true;
  if (const auto* changed = std::get_if<ChangeSettings>(&action)) {
    use_settings(changed->settings);
    refresh();
  }
}

void Shell::use_settings(const ClientSettings& settings) {
  settings_ = settings;
  options_.given = {};
  options_.key_file = settings.key_file;
  apply_settings(settings_, options_);
  const auto saved = save_settings(settings_file_, settings_);
  if (saved) return;
  spdlog::warn("{}", saved.error());
  title_.failure = {"The settings are used, but not kept", saved.error()};
}

bool Shell::take_name(const std::string& name) {
  if (const auto checked = check_player_name(name); !checked) {
    title_.failure = {"This cannot be your name", checked.error()};
    return false;
  }
  if (name == options_.name) return true;
  options_.name = settings_.name = name;
  if (const auto saved = save_settings(settings_file_, settings_); !saved)
    spdlog::warn("{}", saved.error());
  return true;
}

void Shell::join_address(const JoinAddress& chosen) {
  const auto refuse = [this](std::string why) {
    title_.failure = {"This is no address of a server", std::move(why)};
  };
  const auto link = parse_server_link(chosen.address);
  if (!link) return refuse(link.error());
  const auto servers = parse_host_ports(link->address, kDefaultPort);
  if (!servers) return refuse(servers.error());
  if (!take_name(chosen.name)) return;
  Destination to{options_, to_string(servers->front()), {}};
  to.options.server = servers->front();
  to.options.more_servers.assign(servers->begin() + 1, servers->end());
  to.options.ticket = link->ticket;
  to.options.password.clear();
  to.options.servers_file = default_servers_file();
  next_ = std::move(to);
}

void Shell::join_local(const std::string& world, const std::optional<NewLocalWorld>& creation) {
  auto config = local_server_config(world, creation.value_or(NewLocalWorld{}), options_.key_file);
  if (!config) {
    title_.failure = {"This world cannot be started", config.error()};
    return;
  }
  const bool exists = holds_world(config->folder);
  if (!creation && !exists) config->creation.reset();
  next_ = Destination{options_, world, *std::move(config)};
  next_->options.ticket.clear();
  next_->options.password.clear();
}

bool Shell::start_local(Destination& to, const volatile std::sig_atomic_t& stop) {
  save_local();  // the same world may still be saved
  auto started = LocalServer::start(*to.local);
  if (!started) {
    title_.failure = {"This world cannot be started", started.error()};
    return false;
  }
  local_ = *std::move(started);
  ConnectingState state;
  state.to = to.shown;
  state.step = "starting the server of this world";
  bool is_cancelled = false;
  while (local_->poll() == LocalServer::State::starting && !is_cancelled) {
    turn([&](std::array<int, 2> size, double seconds) {
      return menu_->connecting(state, size, seconds);
    });
    for (const MenuAction& action : menu_->take_actions())
      is_cancelled = is_cancelled || std::holds_alternative<CancelJoin>(action);
    is_cancelled = is_cancelled || quits_ || stop != 0;
  }
  if (local_->poll() == LocalServer::State::running) {
    to.options.server = {"127.0.0.1", local_->port()};
    to.options.more_servers.clear();
    to.options.reconnect_seconds = kLocalReconnectSeconds;
    // No certificate names 127.0.0.1, and this server is known by its key.
    to.options.tls = TlsContext::client();
    return true;
  }
  if (!is_cancelled)
    title_.failure = {"The server of this world has ended", local_->failure_text()};
  return false;
}

void Shell::play(Destination to, const volatile std::sig_atomic_t& stop) {
  title_.failure = {};
  title_.asks_password_of.clear();
  menu_->reset();
  if (to.local && !start_local(to, stop)) {
    if (local_) local_->request_stop();
    return;
  }
  last_ = to;
  display_.draw_thread->clear();
  is_frame_in_progress_ = false;
  display_.window->set_title("Runstone  " + to.shown);
  GameMenu game_menu(*menu_, to.shown, to.local.has_value(),
                     [this](const ClientSettings& settings) { use_settings(settings); });
  ClientEnd end;
  try {
    Client client(to.options, nullptr, display_, &game_menu);
    end = client.run(stop);
  } catch (const std::exception& error) {  // the key file, for example
    end.failure = error.what();
    end.words = {"You cannot join", error.what()};
  }
  display_.draw_thread->clear();  // throws if drawing has failed
  if (local_) local_->request_stop();
  take_end(end);
}

void Shell::take_end(const ClientEnd& end) {
  exit_code_ = end.exit_code;
  if (local_ && !end.is_left && local_->poll() == LocalServer::State::ended &&
      !local_->failure_text().empty()) {
    exit_code_ = 0;  // the player reads the reason on the title screen and goes on
    title_.failure = {"The server of this world has ended", local_->failure_text()};
    spdlog::warn("{}", local_->failure_text());
    return;
  }
  if (end.lacks_password) {
    title_.asks_password_of = last_->shown;
    spdlog::info("the title screen asks for the password of {}", last_->shown);
    return;
  }
  if (!end.failure.empty()) {
    exit_code_ = 0;
    title_.failure = {end.words.headline, end.words.detail};
    spdlog::warn("{}: {}", end.words.headline, end.words.detail);
    return;
  }
  if (!end.words.headline.empty()) {
    title_.failure = {end.words.headline, end.words.detail};
    spdlog::warn("{}: {}", end.words.headline, end.words.detail);
  }
  quits_ = quits_ || !end.is_left;
}

void Shell::step_saving() {
  if (!local_) return;
  if (local_->poll() == LocalServer::State::ended) {
    if (!local_->failure_text().empty() && title_.failure.headline.empty())
      title_.failure = {"The server of this world did not end in order", local_->failure_text()};
    local_.reset();
    refresh();
    frames_wanted_ = kFramesAfterInput;
    return;
  }
  title_.notice = "The world is being saved…";
}

void Shell::save_local() {
  if (!local_) return;
  local_->request_stop();
  ConnectingState state;
  state.to = "Runstone";
  state.step = "saving the world…";
  frames_wanted_ = kFramesAfterInput;
  const TimeUs end_us = steady_now_us() + LocalServer::kStopMs * 1'000;
  while (local_->poll() != LocalServer::State::ended && steady_now_us() < end_us) {
    turn([&](std::array<int, 2> size, double seconds) {
      return menu_->connecting(state, size, seconds);
    });
    static_cast<void>(menu_->take_actions());
  }
  local_.reset();
}

}  // namespace runstone
