#include "client/app/threaded_session.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <utility>
#include <variant>

#include "client/net/key_file.hpp"
#include "client/report/link_counts.hpp"
#include "client/session/cache_exchange.hpp"
#include "client/settings/recent_servers.hpp"
#include "common/core/hex.hpp"
#include "common/os/passphrase.hpp"
#include "common/os/steady_clock.hpp"
#include "protocol/codec/key_fingerprint.hpp"

namespace runstone {
namespace {

/// Returns null if the options want no cache or if it cannot be opened, which is logged.
std::unique_ptr<CacheThread> make_cache(const ClientOptions& options,
                                        const std::function<void()>& wake) {
  if (!options.cache) return nullptr;
  const std::string folder = options.cache_dir.empty() ? default_cache_folder() : options.cache_dir;
  if (folder.empty()) {
    spdlog::warn("no chunk cache: neither XDG_CACHE_HOME nor HOME names a folder");
    return nullptr;
  }
  auto cache = ChunkCache::open(folder, options.cache_mib << 20);
  if (!cache) {
    spdlog::warn("{}; this client runs without a cache", cache.error());
    return nullptr;
  }
  if (const std::string warning = (*cache)->take_warning(); !warning.empty())
    spdlog::warn("{}", warning);
  return std::make_unique<CacheThread>(*std::move(cache), std::make_unique<TextureCache>(folder),
                                       wake);
}

SessionConfig session_config(const ClientOptions& options, bool has_cache) {
  SessionConfig config;
  config.ticket = options.ticket;
  if (!options.password.empty()) config.password = std::make_shared<PasswordKeys>(options.password);
  config.has_cache = has_cache;
  config.keys = options.key_file.empty() ? random_key() : load_or_create_key(options.key_file);
  if (!options.key_file.empty()) {
    config.pinned = load_pinned_servers(options.key_file);
    config.features |= kFeatureNames;
  }
  // Scripts and benchmarks begin at the spawn, and get no lines about players who join or leave.
  if (!options.script.empty() || options.benchmark) config.features &= ~kFeatureVisits;
  config.name = options.name;
  config.instance = random_instance();
  config.encodings = options.encodings;
  config.view.radius_h = options.view_radius;
  config.view.radius_v = options.view_radius_v;
  config.view.levels = options.far_levels;
  return config;
}

}  // namespace

ThreadedSession::ThreadedSession(const ClientOptions& options, std::function<void()> wake)
    : options_(options),
      wake_(std::move(wake)),
      cache_(make_cache(options_, wake_)),
      session_(session_config(options_, cache_ != nullptr)),
      pins_saved_(session_.pinned().size()) {}

ThreadedSession::~ThreadedSession() = default;

void ThreadedSession::start(TimeUs now_us) {
  lost_us_ = now_us;
  LinkConfig net;
  net.host = options_.server.host;
  net.port = options_.server.port;
  net.more = options_.more_servers;
  net.tls = options_.tls;
  net_ = std::make_unique<NetClient>(std::move(net), wake_);
}

void ThreadedSession::receive() {
  if (events_.empty()) {
    for (LinkEvent& event : net_->take_events()) events_.push_back(std::move(event));
  }
  for (const TimeUs until_us = steady_now_us() + kReceiveUsMax;
       !events_.empty() && steady_now_us() < until_us;) {
    LinkEvent event = std::move(events_.front());
    events_.pop_front();
    if (const auto* connected = std::get_if<LinkConnected>(&event)) on_connected(*connected);
    if (const auto* gone = std::get_if<LinkDisconnected>(&event)) on_disconnected(*gone);
    if (auto* received = std::get_if<LinkReceived>(&event)) on_received(*received);
  }
  if (can_ask_password()) ask_password();
}

bool ThreadedSession::can_ask_password() const {
  return session_.lacks_password() && options_.asks_at_terminal && !is_password_asked_ &&
         !options_.key_file.empty() && ::isatty(STDIN_FILENO) == 1;
}

void ThreadedSession::ask_password() {
  is_password_asked_ = true;
  save_first_contact();  // a player compares the fingerprint before typing a password
  net_->stop(0);         // it would connect again meanwhile
  const auto password = ask_passphrase("password of this world: ");
  if (!password || password->empty()) return;
  events_.clear();
  connection_ = 0;
  session_.disconnected();
  session_.set_password(std::make_shared<PasswordKeys>(*password));
  start(steady_now_us());
}

void ThreadedSession::on_connected(const LinkConnected& event) {
  connection_ = event.connection;
  session_.connected(random_nonce(), event.binding, steady_now_us(), event.is_listed);
  flush();
}

void ThreadedSession::on_received(LinkReceived& event) {
  if (event.connection != connection_) return;
  if (const auto* chunks = std::get_if<Chunks>(&event.message))
    count_snapshots(snapshots_, *chunks, event);
  session_.receive(std::move(event.message),
                   {event.received_us, event.unpacked_us, steady_now_us()});
  if (std::exchange(servers_seen_, session_.servers_number()) != session_.servers_number())
    net_->set_servers(session_.servers());
  if (session_.connect_count() != connects_handled_) on_world_opened();
}

void ThreadedSession::on_disconnected(const LinkDisconnected& event) {
  if (event.connection != 0 && event.connection != connection_) return;
  connection_ = 0;
  step_cache(steady_now_us(), 0);
  keep_all_chunks();
  session_.disconnected();
  last_failure_ = event.why;
  last_words_ = session_.end() ? words_of(*session_.end())
                               : words_of_link(event.why, to_string(event.server));
  if (session_.end() && !session_.end()->text.empty())
    last_failure_ += " (" + session_.end()->text + ")";
  if (!lost_us_) {
    lost_us_ = steady_now_us();
    spdlog::warn("connection lost: {}", last_failure_);
  } else {
    spdlog::debug("no connection: {}", last_failure_);
  }
}

void ThreadedSession::on_world_opened() {
  connects_handled_ = session_.connect_count();
  world_opened_ = true;
  lost_us_.reset();
  const Welcome& welcome = *session_.welcome();
  spdlog::info("world open author={} epoch={} head={} durable={} edge={}", session_.author(),
               welcome.epoch, welcome.head, welcome.durable, welcome.chunk_edge);
  save_first_contact();
  if (connects_handled_ == 1) list_server();
}

void ThreadedSession::list_server() const {
  if (options_.servers_file.empty()) return;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto saved = save_recent_server(
      options_.servers_file,
      {to_string(options_.server), to_hex(session_.welcome()->world_id), options_.name,
       std::chrono::duration_cast<std::chrono::microseconds>(now).count()});
  if (!saved) spdlog::warn("{}", saved.error());
}

void ThreadedSession::save_first_contact() {
  if (session_.pinned().size() == pins_saved_) return;
  const Welcome& welcome = *session_.welcome();
  spdlog::warn(
      "first contact with the server of world {}: its fingerprint is {}; compare it with the one "
      "that your host sees when the server starts",
      to_hex(welcome.world_id), key_fingerprint(welcome.server_key));
  if (!options_.key_file.empty()) save_pinned_servers(options_.key_file, session_.pinned());
  pins_saved_ = session_.pinned().size();
}

bool ThreadedSession::take_world_opened() { return std::exchange(world_opened_, false); }

void ThreadedSession::flush() {
  for (const Message& message : session_.take_outgoing())
    net_->send(connection_, encode_message(message));
  if (session_.wants_close() && connection_ != 0) net_->close(connection_);
}

void ThreadedSession::step_cache(TimeUs now_us, std::size_t room_bytes) {
  if (!cache_) return;
  exchange_lookups(session_, *cache_, room_bytes, now_us);
  exchange_textures(session_.textures(), *cache_);
  if (now_us - kept_us_ >= kKeepUs) {
    kept_us_ = now_us;
    static_cast<void>(keep_chunks(cache_->room()));
  }
  if (const std::string warning = cache_->take_warning(); !warning.empty())
    spdlog::warn("{}", warning);
}

bool ThreadedSession::keep_chunks(std::size_t count_max) {
  const auto world = session_.cached_world();
  if (!cache_ || !world) return false;
  std::vector<KeyedChunk> batch = session_.replica().take_for_cache(count_max);
  if (batch.empty()) return false;
  cache_->keep(*world, std::move(batch));
  return true;
}

void ThreadedSession::keep_all_chunks() {
  while (keep_chunks(SIZE_MAX)) {
  }
}

void ThreadedSession::finish() {
  step_cache(steady_now_us(), 0);
  keep_all_chunks();
  if (cache_) cache_->stop();
  session_.close(GoodbyeReason::closing, "");
  flush();
  net_->stop(kGoodbyeMs);
}

std::optional<std::string> ThreadedSession::refusal() const {
  const auto& end = session_.end();
  if (!end || !end->final) return std::nullopt;
  if (!session_.lacks_password()) return end->text;
  return end->text + "; this world has a password: start with " +
         (options_.key_file.empty() ? "--key FILE and " : "") + "--password-file FILE";
}

FailureWords ThreadedSession::failure_words() const {
  const auto& end = session_.end();
  return end && end->final ? words_of(*end) : last_words_;
}

double ThreadedSession::seconds_left(TimeUs now_us) const {
  if (!lost_us_) return 0;
  return std::max(0.0, options_.reconnect_seconds - static_cast<double>(now_us - *lost_us_) / 1e6);
}

std::optional<std::string> ThreadedSession::timeout(TimeUs now_us) const {
  if (!lost_us_ || static_cast<double>(now_us - *lost_us_) <= options_.reconnect_seconds * 1e6)
    return std::nullopt;
  return fmt::format("no server at {}: {}", to_string(options_.server), last_failure_);
}

NetCounts ThreadedSession::net_counts() const { return runstone::net_counts(net_->stats()); }

void ThreadedSession::add_to(ClientReport& report) const {
  report.snapshots = snapshots_;
  report.net = net_counts();
  if (cache_) report.cache = cache_->counters();
}

}  // namespace runstone
