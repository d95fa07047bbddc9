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
#include <utility>

#include "client/display/body_marker.hpp"
#include "client/display/ground_marker.hpp"
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
/// A view whose chunks have been here for this long is taken as meshed.
constexpr TimeUs kMeshedUs = 2'000'000;
constexpr TimeUs kTitleUs = 50'000;
constexpr TimeUs kFrameRateUs = 500'000;
constexpr TimeUs kNoticeUs = 4'000'000;
constexpr TimeUs kPlayerLogUs = 1'000'000;
/// The log is divided into this many steps of `[` and `]`.
constexpr Sequence kScrubSteps = 100;

/// Returns null if frames go to no window.
std::unique_ptr<Window> make_window(const ClientOptions& options) {
  if (!options.render || options.headless) return nullptr;
  return std::make_unique<Window>(options.width, options.height, "Runstone");
}

/// Returns null if nothing is drawn.
std::unique_ptr<DrawThread> make_draw_thread(const ClientOptions& options, Window* window,
                                             std::function<void()> wake) {
  if (!options.render) return nullptr;
  const auto make_screen = [window] {
    return window == nullptr ? make_headless_screen() : make_window_screen(*window);
  };
  // Off screen, frames must not delay the threads whose latency is measured.
  const auto priority = window == nullptr ? DrawPriority::background : DrawPriority::normal;
  return std::make_unique<DrawThread>(make_screen, priority, std::move(wake));
}

/// Returns the terminal in which a person may type, or nullopt if there is none or a script plays.
std::optional<int> terminal_of(const Script* script) {
  if (script != nullptr || ::isatty(STDIN_FILENO) != 1) return std::nullopt;
  return STDIN_FILENO;
}

std::string moment_text(const std::optional<PastMoment>& past) {
  if (!past) return {};
  const std::time_t seconds = past->utc_us / 1'000'000;
  return fmt::format("  as it was after edit {} ({:%Y-%m-%d %H:%M:%S} UTC)", past->seq,
                     fmt::gmtime(seconds));
}

std::string memory_text(const MemoryBudget& budget) {
  if (!budget.binds()) return {};
  return fmt::format("  view {} of {} chunks (memory)", budget.radii().h, budget.wanted().h);
}

}  // namespace

Client::Client(ClientOptions options, const Script* script)
    : options_(std::move(options)),
      network_(options_, [this] { wake_.notify(); }),
      session_(network_.session()),
      window_(make_window(options_)),
      pipeline_(session_.replica(),
                make_draw_thread(options_, window_.get(), [this] { wake_.notify(); }),
                window_ != nullptr, options_.workers, [this] { wake_.notify(); }),
      tool_(session_, player_, pipeline_.recorder()),
      budget_(options_.memory_mib << 20, {options_.view_radius, options_.view_radius_v}),
      view_(session_, player_, budget_.radii()),
      chat_(session_, terminal_of(script)),
      actions_(session_, player_, pipeline_, tool_, view_, chat_, options_.screenshot_dir) {
  shows_ground_ = options_.show_protected;
  spdlog::info("renderer={}", pipeline_.renderer_name());
  if (script != nullptr) runner_.emplace(*script, actions_);
  started_us_ = polled_us_ = steady_now_us();
  network_.start(started_us_);
}

Client::~Client() = default;

int Client::run(const volatile std::sig_atomic_t& stop) {
  int code = kExitNoStart;
  try {
    code = run_turns(stop);
  } catch (const std::exception& error) {
    // The program still writes the measurements so far and the script's failures.
    std::fprintf(stderr, "runstone-client: %s\n", error.what());
  }
  return finish(code);
}

int Client::run_turns(const volatile std::sig_atomic_t& stop) {
  std::optional<int> code;
  while (!code) {
    network_.receive();
    if (network_.take_world_opened()) on_world_opened();
    take_new_materials();
    drain_changes();  // before the script asks whether all of it is drawn
    const TimeUs now_us = steady_now_us();
    limit_memory(now_us);
    poll_window(now_us);
    pipeline_.take_drawn();
    log_players(now_us);
    chat_.step();
    view_.update_completeness(now_us);
    if (runner_) runner_->step(now_us);
    flush();  // local edits go first, because following the player may take long
    follow_player(now_us);
    session_.tick(now_us);
    network_.step_cache(now_us, budget_.room(memory_use()));
    flush();
    draw(now_us);
    if (stop != 0) end_requested_ = true;
    code = exit_code(steady_now_us());
    if (!code) rest(steady_now_us());
  }
  return *code;
}

void Client::on_world_opened() {
  const Welcome& welcome = *session_.welcome();
  player_.enter(welcome.world_id, welcome.spawn);
  pipeline_.set_materials(welcome.materials);
  body_materials_ = body_materials(welcome.materials);
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
  spdlog::info("the world has {} new materials", welcome->materials.size() - known);
}

void Client::flush() {
  network_.flush();
  drain_changes();
  pipeline_.mesh();
}

void Client::poll_window(TimeUs now_us) {
  if (!window_) return;
  const WindowInput input = window_->poll();
  const double seconds = static_cast<double>(now_us - polled_us_) / 1e6;
  polled_us_ = now_us;
  if (input.close || input.escape) end_requested_ = true;
  if (runner_) return;  // the script moves the player
  move_player(input, std::min(seconds, 0.1));
  edit_with(input, now_us);
  if (input.scrub != 0) scrub(input.scrub);
  if (input.undo) static_cast<void>(session_.command("undo"));
  if (input.redo) static_cast<void>(session_.command("redo"));
  if (input.ground % 2 != 0) shows_ground_ = !shows_ground_;
  if (input.live) static_cast<void>(session_.request_history({}));
  if (input.screenshot) take_picture(now_us);
  pipeline_.moved();
}

void Client::edit_with(const WindowInput& input, TimeUs now_us) {
  const auto note = [&](const Result<void, std::string>& done) {
    if (!done) tell(done.error(), now_us);
  };
  int acts = remove_button_.acts(input.remove_clicks, input.remove_held, now_us);
  while (acts-- > 0) note(tool_.remove(now_us));
  acts = place_button_.acts(input.place_clicks, input.place_held, now_us);
  while (acts-- > 0) note(tool_.place(now_us));
  if (input.pick_clicks == 0) return;
  if (const auto hit = tool_.pick()) player_.hold(hit->material);
}

void Client::take_picture(TimeUs now_us) {
  const TimeUs utc_us = actions_.utc_now_us();
  const std::string file = fmt::format("runstone-{:%Y-%m-%d-%H%M%S}-{:03}.png",
                                       fmt::gmtime(utc_us / 1'000'000), utc_us / 1'000 % 1'000);
  if (actions_.screenshot(file)) tell("picture: " + actions_.screenshot_path(file), now_us);
}

void Client::move_player(const WindowInput& input, double seconds) {
  player_.turn(input, pipeline_.materials().size());
  if (input.walking % 2 != 0) player_.set_walking(!player_.is_walking());
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
    if (!logged_refusal_.empty()) spdlog::warn("the past is not shown: {}", logged_refusal_);
  }
  const bool is_read_only = session_.is_server_read_only();
  if (std::exchange(logged_read_only_, is_read_only) != is_read_only) {
    spdlog::warn(is_read_only ? "the server is read-only: its disk is full"
                              : "the server accepts edits again");
  }
  for (const RejectedEdit& reject : changes.rejects) {
    spdlog::info("edit={} rejected: {} {}", reject.seq, to_string(reject.reason), reject.detail);
    tell(fmt::format("the server refused an edit: {} {}", to_string(reject.reason), reject.detail),
         steady_now_us());
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

std::vector<Marker> Client::markers() const {
  std::vector<Marker> out;
  for (const auto& [author, other] : session_.others()) {
    if (!other.pose) continue;
    if (const auto body = body_marker(author, other.pose->at, player_.eye())) out.push_back(*body);
  }
  add_ground(out);
  if (options_.headless) return out;
  if (const auto hit = tool_.pick()) {
    const auto at = [](std::int32_t v) { return v - 0.002; };
    out.push_back({at(hit->voxel.x), at(hit->voxel.y), at(hit->voxel.z), 1.004, 1.004, 1.004, 20,
                   20, 20, false});
  }
  // The crosshair is a small cube in front of the eye.
  const WorldPos eye = player_.eye();
  const LookDirection look = player_.direction();
  constexpr double kAhead = 0.5, kSize = 0.004;
  const auto dot = [&](double from, double slope) { return from + slope * kAhead - kSize / 2; };
  out.push_back({dot(eye.x, look.x), dot(eye.y, look.y), dot(eye.z, look.z), kSize, kSize, kSize,
                 255, 255, 255, true});
  return out;
}

void Client::draw(TimeUs now_us) {
  const Camera camera = player_.camera(draw_distance());
  const std::array<int, 2> size =
      window_ ? window_->framebuffer_size() : std::array{options_.width, options_.height};
  pipeline_.draw(now_us, camera, size, [this] { return markers(); });
  update_title(now_us);
}

void Client::tell(std::string text, TimeUs now_us) {
  notice_ = std::move(text);
  notice_until_us_ = now_us + kNoticeUs;
}

void Client::update_title(TimeUs now_us) {
  if (!window_ || now_us - titled_us_ < kTitleUs) return;
  titled_us_ = now_us;
  if (now_us - counted_us_ >= kFrameRateUs) {
    const std::uint64_t frames = pipeline_.frames_presented();
    frame_rate_ = static_cast<double>(frames - counted_frames_) * 1e6 /
                  static_cast<double>(now_us - counted_us_);
    counted_us_ = now_us;
    counted_frames_ = frames;
  }
  const WorldPos at = player_.eye();
  const Material held = player_.held();
  const MaterialTable& materials = pipeline_.materials();
  std::string title =
      fmt::format("Runstone  {:.0f} fps  {}  {:.0f} {:.0f} {:.0f}{}{}", frame_rate_,
                  materials.knows(held) ? materials[held].name : "", at.x, at.y, at.z,
                  moment_text(session_.replica().past()), memory_text(budget_));
  if (!network_.is_connected()) {
    title += "  (connecting)";
  } else if (now_us < notice_until_us_) {
    title += "  (" + notice_ + ")";
  } else if (!window_->mouse_captured()) {
    title += "  (click to play)";
  }
  if (title == title_) return;
  title_ = std::move(title);
  window_->set_title(title_);
}

std::optional<int> Client::exit_code(TimeUs now_us) {
  if (const auto refusal = network_.refusal()) {
    std::fprintf(stderr, "runstone-client: %s\n", refusal->c_str());
    return kExitNoStart;
  }
  if (runner_ && runner_->finished() && pipeline_.screenshots_done() && pipeline_.has_caught_up()) {
    return runner_->failures().empty() && !drift_found() ? kExitOk : kExitFailed;
  }
  const bool has_goodbye = session_.end() && session_.end()->by_server;
  if (end_requested_ || (has_goodbye && options_.exit_on_goodbye))
    return drift_found() ? kExitFailed : kExitOk;
  if (const auto timeout = network_.timeout(now_us)) {
    std::fprintf(stderr, "runstone-client: %s\n", timeout->c_str());
    return kExitNoStart;
  }
  return std::nullopt;
}

void Client::rest(TimeUs now_us) {
  if (network_.has_events()) return;
  TimeUs pause = window_ ? kRestUsWindow : kRestUs;
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
