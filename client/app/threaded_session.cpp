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

SessionConfig session_config(const ClientOptions& options) {
  SessionConfig config;
  config.ticket = options.ticket;
  if (!options.password.empty()) config.password = std::make_shared<PasswordKeys>(options.password);
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
      threads_(session_config(options_), make_cache(options_, wake_), *this) {
  pins_saved_ = session().pinned().size();
}

ThreadedSession::~ThreadedSession() = default;

void ThreadedSession::start(TimeUs now_us) {
  lost_us_ = now_us;
  LinkConfig net;
  net.host = options_.server.host;
  net.port = options_.server.port;
  net.more = options_.more_servers;
  net.tls = options_.tls;
  threads_.connect(std::move(net), wake_);
}

void ThreadedSession::receive() {
  threads_.receive();
  if (can_ask_password()) ask_password();
}

bool ThreadedSession::can_ask_password() const {
  return session().lacks_password() && options_.asks_at_terminal && !is_password_asked_ &&
         !options_.key_file.empty() && ::isatty(STDIN_FILENO) == 1;
}

void ThreadedSession::ask_password() {
  is_password_asked_ = true;
  save_first_contact();   // a player compares the fingerprint before typing a password
  threads_.disconnect();  // it would connect again meanwhile
  const auto password = ask_passphrase("password of this world: ");
  if (!password || password->empty()) return;
  session().set_password(std::make_shared<PasswordKeys>(*password));
  start(steady_now_us());
}

void ThreadedSession::on_message(const LinkReceived& event) {
  if (const auto* chunks = std::get_if<Chunks>(&event.message))
    count_snapshots(snapshots_, *chunks, event);
}

void ThreadedSession::on_cache_warning(std::string warning) { spdlog::warn("{}", warning); }

void ThreadedSession::on_connection_lost(const LinkDisconnected& event) {
  last_failure_ = event.why;
  last_words_ = session().end() ? words_of(*session().end())
                                : words_of_link(event.why, to_string(event.server));
  if (session().end() && !session().end()->text.empty())
    last_failure_ += " (" + session().end()->text + ")";
  if (!lost_us_) {
    lost_us_ = steady_now_us();
    spdlog::warn("connection lost: {}", last_failure_);
  } else {
    spdlog::debug("no connection: {}", last_failure_);
  }
}

void ThreadedSession::on_world_opened() {
  world_opened_ = true;
  lost_us_.reset();
  const Welcome& welcome = *session().welcome();
  spdlog::info("world open author={} epoch={} head={} durable={} edge={}", session().author(),
               welcome.epoch, welcome.head, welcome.durable, welcome.chunk_edge);
  save_first_contact();
  if (session().connect_count() == 1) list_server();
}

void ThreadedSession::list_server() const {
  if (options_.servers_file.empty()) return;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto saved = save_recent_server(
      options_.servers_file,
      {to_string(options_.server), to_hex(session().welcome()->world_id), options_.name,
       std::chrono::duration_cast<std::chrono::microseconds>(now).count()});
  if (!saved) spdlog::warn("{}", saved.error());
}

void ThreadedSession::save_first_contact() {
  if (session().pinned().size() == pins_saved_) return;
  const Welcome& welcome = *session().welcome();
  spdlog::warn(
      "first contact with the server of world {}: its fingerprint is {}; compare it with the one "
      "that your host sees when the server starts",
      to_hex(welcome.world_id), key_fingerprint(welcome.server_key));
  if (!options_.key_file.empty()) save_pinned_servers(options_.key_file, session().pinned());
  pins_saved_ = session().pinned().size();
}

bool ThreadedSession::take_world_opened() { return std::exchange(world_opened_, false); }

std::optional<std::string> ThreadedSession::refusal() const {
  const auto& end = session().end();
  if (!end || !end->final) return std::nullopt;
  if (!session().lacks_password()) return end->text;
  return end->text + "; this world has a password: start with " +
         (options_.key_file.empty() ? "--key FILE and " : "") + "--password-file FILE";
}

FailureWords ThreadedSession::failure_words() const {
  const auto& end = session().end();
  if (end && end->final) return words_of(*end);
  return last_failure_.empty() ? words_of_link("", to_string(options_.server)) : last_words_;
}

double ThreadedSession::seconds_left(TimeUs now_us) const {
  if (!lost_us_) return 0;
  return std::max(0.0, options_.reconnect_seconds - static_cast<double>(now_us - *lost_us_) / 1e6);
}

std::optional<std::string> ThreadedSession::timeout(TimeUs now_us) const {
  if (!lost_us_ || static_cast<double>(now_us - *lost_us_) <= options_.reconnect_seconds * 1e6)
    return std::nullopt;
  return fmt::format("no server at {}: {}", to_string(options_.server),
                     last_failure_.empty() ? "it has not answered yet" : last_failure_);
}

NetCounts ThreadedSession::net_counts() const { return runstone::net_counts(threads_.net_stats()); }

void ThreadedSession::add_to(ClientReport& report) const {
  report.snapshots = snapshots_;
  report.net = net_counts();
  if (const CacheThread* cache = threads_.cache()) report.cache = cache->counters();
}

}  // namespace runstone
