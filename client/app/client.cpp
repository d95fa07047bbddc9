#include "client/app/client.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <type_traits>
#include <utility>

#include "client/display/body_marker.hpp"
#include "client/net/key_file.hpp"
#include "client/replica/surface.hpp"
#include "common/core/key_text.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {
namespace {

constexpr TimeUs kRestUs = 10'000;  // longest pause of the loop: session ticks
constexpr TimeUs kInputUs =
    2'000;  // longest pause with a window: how late a key or click is noticed
constexpr TimeUs kTitleUs = 500'000;
constexpr TimeUs kSettleUsMax =
    10'000'000;  // for all that is here to be drawn without anything new to draw
constexpr Sequence kScrubSteps = 100;  // from the first edit to the newest
constexpr TimeUs kEventsUs =
    1'000;  // of a turn for messages: then own edits, meshes and frames get theirs
constexpr TimeUs kKeepUs = 2'000'000;       // between two batches for the chunk cache
constexpr std::int64_t kGoodbyeMs = 1'000;  // to say goodbye

/// Null where nothing is to be seen.
std::unique_ptr<Window> make_window(const ClientOptions& options) {
  if (!options.render || options.headless) return nullptr;
  return std::make_unique<Window>(options.width, options.height, "Runstone");
}

/// Null where nothing is to be drawn.
std::unique_ptr<DrawThread> make_draw_thread(const ClientOptions& options, Window* window,
                                             std::function<void()> wake) {
  if (!options.render) return nullptr;
  const auto make_screen = [window] {
    return window == nullptr ? make_headless_screen() : make_window_screen(*window);
  };
  // Frames that nobody watches give way to what is measured.
  const auto priority = window == nullptr ? DrawPriority::background : DrawPriority::normal;
  return std::make_unique<DrawThread>(make_screen, priority, std::move(wake));
}

std::string moment_text(const std::optional<PastMoment>& past) {
  if (!past) return {};
  const std::time_t seconds = past->utc_us / 1'000'000;
  return fmt::format("  as it was after edit {} ({:%Y-%m-%d %H:%M:%S} UTC)", past->seq,
                     fmt::gmtime(seconds));
}

/// Null without a cache; a cache that cannot be had is a warning.
std::unique_ptr<CacheThread> make_cache(const ClientOptions& options, std::function<void()> wake) {
  if (!options.cache) return nullptr;
  const std::string folder = options.cache_dir.empty() ? default_cache_folder() : options.cache_dir;
  if (folder.empty()) {
    spdlog::warn("no chunk cache: neither XDG_CACHE_HOME nor HOME names a folder");
    return nullptr;
  }
  auto cache = ChunkCache::open(folder, options.cache_mib << 20);
  if (!cache) {
    spdlog::warn("{}; this client goes without", cache.error());
    return nullptr;
  }
  if (const std::string warning = (*cache)->take_warning(); !warning.empty())
    spdlog::warn("{}", warning);
  return std::make_unique<CacheThread>(*std::move(cache), std::move(wake));
}

SessionConfig session_config(const ClientOptions& options, bool has_cache) {
  SessionConfig config;
  config.has_cache = has_cache;
  config.keys = options.key_file.empty() ? random_key() : load_or_create_key(options.key_file);
  if (!options.key_file.empty()) config.pinned = load_pinned_servers(options.key_file);
  config.name = options.name;
  config.instance = random_instance();
  config.encodings = options.encodings;
  config.view = {{}, options.view_radius, options.view_radius_v};
  return config;
}

}  // namespace

Client::Client(ClientOptions options, const Script* script)
    : options_(std::move(options)),
      cache_(make_cache(options_, [this] { wake_.notify(); })),
      session_(session_config(options_, cache_ != nullptr)),
      pins_known_(session_.pinned().size()),
      window_(make_window(options_)),
      pipeline_(session_.replica(),
                make_draw_thread(options_, window_.get(), [this] { wake_.notify(); }),
                window_ != nullptr, options_.workers, [this] { wake_.notify(); }) {
  spdlog::info("renderer={}", pipeline_.renderer_name());
  if (script != nullptr) runner_.emplace(*script, static_cast<ScriptHost&>(*this));
  started_us_ = steady_now_us();
  lost_us_ = started_us_;
  input_us_ = started_us_;
  NetConfig net;
  net.host = options_.host;
  net.port = options_.port;
  net_ = std::make_unique<NetClient>(std::move(net), [this] { wake_.notify(); });
}

Client::~Client() = default;

int Client::run(const volatile std::sig_atomic_t& stop) {
  int code = kExitNoStart;
  try {
    code = play(stop);
  } catch (const std::exception& error) {
    // What was measured until now, and what the script found, are wanted all the more.
    std::fprintf(stderr, "runstone-client: %s\n", error.what());
  }
  return finish(code);
}

int Client::play(const volatile std::sig_atomic_t& stop) {
  std::optional<int> code;
  while (!code) {
    take_events();
    drain_changes();  // before the script asks whether all of it is drawn
    const TimeUs now_us = steady_now_us();
    take_input(now_us);
    pipeline_.take_drawn();
    see_completeness(now_us);
    if (runner_) runner_->step(now_us);
    settle();  // own edits first: to follow the player may take long
    follow_player(now_us);
    session_.tick(now_us);
    step_cache(now_us, false);
    settle();
    draw(now_us);
    if (stop != 0) wish_to_end_ = kExitOk;
    code = exit_code(steady_now_us());
    if (!code) rest(steady_now_us());
  }
  return *code;
}

// ---- network

void Client::take_events() {
  if (events_.empty()) {
    for (NetEvent& event : net_->take_events()) events_.push_back(std::move(event));
  }
  for (const TimeUs until_us = steady_now_us() + kEventsUs;
       !events_.empty() && steady_now_us() < until_us;) {
    NetEvent event = std::move(events_.front());
    events_.pop_front();
    if (const auto* connected = std::get_if<NetConnected>(&event)) on_connected(*connected);
    if (const auto* gone = std::get_if<NetDisconnected>(&event)) on_disconnected(*gone);
    if (auto* received = std::get_if<NetReceived>(&event)) on_received(*received);
  }
}

void Client::on_connected(const NetConnected& event) {
  connection_ = event.connection;
  session_.connected(random_nonce(), steady_now_us());
  flush();
}

void Client::on_received(NetReceived& event) {
  if (event.connection != connection_) return;
  if (const auto* snapshot = std::get_if<ChunkSnapshot>(&event.message)) {
    ++chunk_stats_.snapshots;
    chunk_stats_.wire_bytes += event.bytes;
    chunk_stats_.raw_bytes += raw_bytes(snapshot->chunk.voxels);
    chunk_stats_.runs.add(static_cast<std::int64_t>(snapshot->chunk.voxels.runs.size()));
    chunk_stats_.unpack_ns.add(event.unpack_ns);
  }
  session_.receive(std::move(event.message),
                   {event.received_us, event.unpacked_us, steady_now_us()});
  if (session_.connect_count() != connects_seen_) world_opened();
}

void Client::on_disconnected(const NetDisconnected& event) {
  if (event.connection != 0 && event.connection != connection_) return;
  connection_ = 0;
  step_cache(steady_now_us(), true);
  session_.disconnected();
  last_failure_ = event.why;
  if (session_.end() && !session_.end()->text.empty())
    last_failure_ += " (" + session_.end()->text + ")";
  if (!lost_us_) {
    lost_us_ = steady_now_us();
    spdlog::warn("connection lost: {}", last_failure_);
  } else {
    spdlog::debug("no connection: {}", last_failure_);
  }
}

void Client::world_opened() {
  connects_seen_ = session_.connect_count();
  lost_us_.reset();
  const Welcome& welcome = *session_.welcome();
  spdlog::info("world open author={} epoch={} head={} durable={} edge={}", session_.author(),
               welcome.epoch, welcome.head, welcome.durable, welcome.chunk_edge);
  player_.enter(welcome.world_id, welcome.spawn);
  pipeline_.set_materials(welcome.materials);
  if (!options_.key_file.empty() && session_.pinned().size() != pins_known_) {
    save_pinned_servers(options_.key_file, session_.pinned());
    pins_known_ = session_.pinned().size();
  }
}

void Client::settle() {
  flush();
  drain_changes();
  pipeline_.mesh();
}

void Client::flush() {
  for (const Message& message : session_.take_outgoing())
    net_->send(connection_, encode_message(message));
  if (session_.wants_close() && connection_ != 0) net_->close(connection_);
}

void Client::step_cache(TimeUs now_us, bool all) {
  if (!cache_) return;
  for (auto& found : cache_->take_answers()) session_.receive_cached(std::move(found), now_us);
  while (auto question = session_.take_cache_lookup()) cache_->ask(*std::move(question));
  if (all || now_us - kept_us_ >= kKeepUs) {
    kept_us_ = now_us;
    if (const auto world = session_.cached_world()) {
      cache_->keep(*world, session_.replica().take_for_cache(all ? SIZE_MAX : cache_->room()));
    }
  }
  if (const std::string warning = cache_->take_warning(); !warning.empty())
    spdlog::warn("{}", warning);
}

// ---- player

void Client::take_input(TimeUs now_us) {
  if (!window_) return;
  const WindowInput input = window_->poll();
  const double seconds = static_cast<double>(now_us - input_us_) / 1e6;
  input_us_ = now_us;
  if (input.close || input.escape) wish_to_end_ = kExitOk;
  if (runner_) return;  // the script steers
  player_.steer(input, std::min(seconds, 0.1), pipeline_.materials().size());
  for (int i = 0; i < input.remove_clicks; ++i) click(false, now_us);
  for (int i = 0; i < input.place_clicks; ++i) click(true, now_us);
  if (input.scrub != 0) scrub(input.scrub);
  if (input.undo) static_cast<void>(session_.command("undo"));
  if (input.redo) static_cast<void>(session_.command("redo"));
  if (input.live) static_cast<void>(session_.request_history({}));
  if (input.screenshot) static_cast<void>(screenshot(fmt::format("runstone-{}.png", now_us)));
  pipeline_.moved();
}

void Client::click(bool place, TimeUs now_us) {
  const auto hit = pick();
  if (!hit) return;
  const auto at = place ? place_against(*hit) : hit->voxel;
  if (at)
    static_cast<void>(submit({SetVoxel{*at}, {}, place ? player_.held() : kEmpty}, now_us, now_us));
}

std::string Client::command(const std::string& text) {
  const auto given = session_.command(text);
  return given ? std::string() : given.error().what;
}

bool Client::show_answer() {
  for (const std::string& line : session_.command_lines()) fmt::print("{}\n", line);
  std::fflush(stdout);
  return session_.command_ok();
}

void Client::scrub(int steps) {
  const Sequence newest = session_.replica().newest();
  const bool is_away = session_.replica().past() || session_.loading_history();
  const auto from = static_cast<std::int64_t>(is_away ? scrubbed_to_ : newest);
  const auto step = static_cast<std::int64_t>(std::max<Sequence>(1, newest / kScrubSteps));
  const auto to = static_cast<Sequence>(std::max<std::int64_t>(0, from + steps * step));
  HistoryRequest travel;  // live
  if (to < newest) {
    travel.to = HistoryTarget::sequence;
    travel.seq = scrubbed_to_ = to;
  }
  static_cast<void>(session_.request_history(travel));
}

void Client::see_completeness(TimeUs now_us) {
  if (!is_complete()) {
    complete_us_.reset();
  } else if (!complete_us_) {
    complete_us_ = now_us;
  }
}

void Client::follow_player(TimeUs now_us) {
  session_.set_pose(player_.pose());
  if (!session_.replica().opened()) return;
  const ChunkCoord centre = player_.chunk(session_.replica().chunk_edge());
  View view = session_.view();
  view.centre = centre;
  view.yaw = player_.pose().yaw;
  view.pitch = player_.pose().pitch;
  view.cone = kSightCone;
  if (view_pace_.step(session_.view(), view, now_us)) {
    const bool moves = !session_.view().same_chunks(view);
    view.radius_h = options_.view_radius;
    view.radius_v = options_.view_radius_v;
    session_.set_view(view);
    if (moves) pipeline_.view_changed();
  }
  pipeline_.joined(session_.view(), started_us_);
  pipeline_.set_eye(centre);
}

// ---- picture

void Client::drain_changes() {
  const ReplicaChanges news = session_.replica().drain_changes();
  pipeline_.take(news, session_.clock(), steady_now_us());
  for (const auto& [key, reason] : news.unavailable) {
    spdlog::warn("chunk={} unavailable: {}", text_of(key), to_string(reason));
  }
  for (const RejectedEdit& reject : news.rejects) {
    spdlog::info("edit={} rejected: {} {}", reject.seq, to_string(reject.reason), reject.detail);
  }
}

std::vector<Marker> Client::markers() const {
  std::vector<Marker> out;
  for (const auto& [author, other] : session_.others()) {
    if (!other.pose) continue;
    if (const auto body = body_marker(author, other.pose->at, player_.eye())) out.push_back(*body);
  }
  if (options_.headless) return out;
  if (const auto hit = pick()) {
    const auto at = [](std::int32_t v) { return v - 0.002; };
    out.push_back({at(hit->voxel.x), at(hit->voxel.y), at(hit->voxel.z), 1.004, 1.004, 1.004, 20,
                   20, 20, false});
  }
  const WorldPos eye = player_.eye();
  const LookDirection look = player_.direction();
  constexpr double kAhead = 0.5, kSize = 0.004;
  const auto dot = [&](double from, double slope) { return from + slope * kAhead - kSize / 2; };
  out.push_back({dot(eye.x, look.x), dot(eye.y, look.y), dot(eye.z, look.z), kSize, kSize, kSize,
                 255, 255, 255, true});
  return out;
}

void Client::draw(TimeUs now_us) {
  const double edge = std::max(16, session_.replica().chunk_edge());
  const Camera camera = player_.camera((options_.view_radius + 1.5) * edge);
  const std::array<int, 2> size =
      window_ ? window_->framebuffer_size() : std::array{options_.width, options_.height};
  pipeline_.draw(now_us, camera, size, [this] { return markers(); });
  show_title(now_us);
}

void Client::show_title(TimeUs now_us) {
  if (!window_ || now_us - title_us_ < kTitleUs) return;
  const WorldPos at = player_.eye();
  const Material held = player_.held();
  const MaterialTable& materials = pipeline_.materials();
  const std::uint64_t frames = pipeline_.frames_presented();
  window_->set_title(fmt::format(
      "Runstone  {:.0f} fps  {}  {:.0f} {:.0f} {:.0f}{}{}",
      static_cast<double>(frames - title_frames_) * 1e6 / static_cast<double>(now_us - title_us_),
      materials.knows(held) ? materials[held].name : "", at.x, at.y, at.z,
      moment_text(session_.replica().past()), lost_us_ ? "  (connecting)" : ""));
  title_us_ = now_us;
  title_frames_ = frames;
}

std::string Client::screenshot_path(const std::string& file) const {
  return (std::filesystem::path(options_.screenshot_dir) / file).string();
}

// ---- end

std::optional<int> Client::exit_code(TimeUs now_us) {
  const auto& end = session_.end();
  if (end && end->final) {
    std::fprintf(stderr, "runstone-client: %s\n", end->text.c_str());
    return kExitNoStart;
  }
  if (runner_ && runner_->finished() && pipeline_.screenshots_done() && pipeline_.has_caught_up()) {
    return runner_->failures().empty() && !drift_found() ? kExitOk : kExitFailed;
  }
  if (wish_to_end_) return drift_found() ? kExitFailed : *wish_to_end_;
  if (end && end->by_server && options_.exit_on_goodbye)
    return drift_found() ? kExitFailed : kExitOk;
  if (lost_us_ && static_cast<double>(now_us - *lost_us_) > options_.reconnect_seconds * 1e6) {
    std::fprintf(stderr, "runstone-client: no server at %s:%u: %s\n", options_.host.c_str(),
                 unsigned{options_.port}, last_failure_.c_str());
    return kExitNoStart;
  }
  return std::nullopt;
}

void Client::rest(TimeUs now_us) {
  if (!events_.empty()) return;
  TimeUs pause = window_ ? kInputUs : kRestUs;
  if (runner_ && runner_->due_us()) pause = std::min(pause, *runner_->due_us() - now_us);
  if (pause > 0) wake_.wait(std::chrono::microseconds(pause));
}

ClientReport Client::report() const {
  ClientReport out;
  out.renderer = pipeline_.renderer_name();
  out.seconds = static_cast<double>(steady_now_us() - started_us_) / 1e6;
  out.latency = pipeline_.recorder().report();
  out.join = pipeline_.join();
  out.chunks = chunk_stats_;
  pipeline_.report(out.chunks, out.frames);
  const NetStats& net = net_->stats();
  out.net.bytes_received = net.bytes_received;
  out.net.bytes_sent = net.bytes_sent;
  const Traffic received = net.received.read();
  out.net.control_bytes = of_class(received, FrameClass::control).bytes;
  out.net.edit_bytes = of_class(received, FrameClass::edits).bytes;
  out.net.chunk_bytes = of_class(received, FrameClass::chunks).bytes;
  for (const KindTraffic& kind : received) out.net.messages_received += kind.messages;
  out.net.connections = net.connections;
  if (cache_) out.cache = cache_->counters();
  return out;
}

int Client::finish(int code) {
  step_cache(steady_now_us(), true);
  if (cache_) cache_->stop();
  session_.close(GoodbyeReason::closing, "");
  flush();
  net_->stop(kGoodbyeMs);
  if (runner_) {
    for (const std::string& failure : runner_->failures())
      std::fprintf(stderr, "%s\n", failure.c_str());
  }
  const ClientReport measured = report();
  if (!options_.report.empty() && !write_text(options_.report, to_json(measured, session_))) {
    std::fprintf(stderr, "runstone-client: cannot write %s\n", options_.report.c_str());
    code = std::max(code, kExitFailed);
  }
  if (!options_.digests.empty() && !write_digests(options_.digests, session_)) {
    std::fprintf(stderr, "runstone-client: cannot write %s\n", options_.digests.c_str());
    code = std::max(code, kExitFailed);
  }
  if (session_.connect_count() != 0) std::fputs(to_table(measured, session_).c_str(), stdout);
  spdlog::info("exit code={}", code);
  return code;
}

// ---- what a script may do

void Client::move_to(const WorldPos& eye) {
  player_.move_to(eye);
  pipeline_.moved();
}

void Client::look(double yaw, double pitch) {
  player_.look(yaw, pitch);
  pipeline_.moved();
}

std::optional<Material> Client::material(std::string_view name) const {
  unsigned id = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), id);
  if (error == std::errc{} && end == name.data() + name.size()) {
    if (id >= pipeline_.materials().size()) return std::nullopt;
    return static_cast<Material>(id);
  }
  return pipeline_.materials().find(name);
}

std::optional<RayHit> Client::pick() const {
  return runstone::pick(session_.replica(), player_.eye(), player_.direction(), kReach);
}

std::optional<std::int32_t> Client::surface(std::int32_t x, std::int32_t z) const {
  return surface_of(session_.replica(), x, z);
}

TimeUs Client::utc_now_us() const {
  const auto utc = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(utc).count();
}

bool Client::submit(const EditDescriptor& edit, TimeUs due_us, TimeUs now_us) {
  const auto seq = session_.submit(edit, due_us, now_us);
  if (!seq) {
    pipeline_.recorder().not_submitted();
    spdlog::warn("edit not taken: {}", seq.error().what);
    return false;
  }
  pipeline_.recorder().submitted(*seq, due_us);
  return true;
}

bool Client::view_has_followed() const {
  return session_.replica().opened() &&
         session_.view().centre == player_.chunk(session_.replica().chunk_edge());
}

bool Client::loaded() const {
  if (!is_complete()) return false;
  // Where others never stop editing there is always a mesh to make: then what was drawn meanwhile is the picture.
  return pipeline_.is_settled() ||
         (complete_us_ && steady_now_us() - *complete_us_ >= kSettleUsMax);
}

bool Client::synced(std::uint64_t mark) const {
  // Two pongs: the first may answer a ping sent before the mark.
  return is_complete() && session_.pongs() >= mark + 2 &&
         session_.replica().local_edits().unanswered().empty();
}

bool Client::screenshot(const std::string& file) {
  if (!pipeline_.draws()) return false;
  pipeline_.request_screenshot(screenshot_path(file), steady_now_us());
  return true;
}

std::optional<bool> Client::screenshot_written() const {
  if (!pipeline_.screenshots_done()) return std::nullopt;
  return pipeline_.screenshots_written();
}

}  // namespace runstone
