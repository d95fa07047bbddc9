#include "client/api/joined_session.hpp"

#include <stdexcept>
#include <utility>
#include <variant>

#include "client/net/key_file.hpp"
#include "client/session/cache_exchange.hpp"
#include "client/session/failure_words.hpp"
#include "client/session/join_check.hpp"
#include "common/os/host_port.hpp"
#include "common/os/steady_clock.hpp"
#include "protocol/codec/server_link.hpp"
#include "protocol/default_port.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

constexpr std::uint64_t kMemoryMibMin = 16, kMemoryMibMax = 65'536;
constexpr std::uint64_t kCacheMibMax = std::uint64_t{1} << 20;
constexpr std::size_t kReportsMax = 64;

/// The features of servers that a WorldClient does not use.
constexpr std::uint64_t kUnusedFeatures =
    kFeatureNames | kFeatureKeyTransfer | kFeatureTextures | kFeaturePreviews;

struct ServerAddresses {
  std::vector<HostPort> servers;  // at least one
  std::string ticket;
};

Result<ServerAddresses, std::string> addresses_of(const WorldClientOptions& options) {
  auto link = parse_server_link(options.server);
  if (!link) return failure("server: " + link.error());
  auto servers = parse_host_ports(link->address, kDefaultPort);
  if (!servers) return failure("server: " + servers.error());
  if (!options.invite.empty()) link->ticket = options.invite;
  if (const auto right = check_ticket(link->ticket); !right)
    return failure("invite: " + right.error());
  return ServerAddresses{*std::move(servers), std::move(link->ticket)};
}

Result<void, std::string> check_options(const WorldClientOptions& options) {
  if (const auto right = check_player_name(options.name); !right)
    return failure("name: " + right.error());
  if (options.view_radius > kViewRadiusMax || options.view_radius_vertical > kViewRadiusMax)
    return failure("view_radius: a view has a radius of 0 to " + std::to_string(kViewRadiusMax) +
                   " chunks");
  if (options.memory_mib < kMemoryMibMin || options.memory_mib > kMemoryMibMax)
    return failure("memory_mib: expected 16 to 65536 MiB");
  if (options.cache_mib == 0 || options.cache_mib > kCacheMibMax)
    return failure("cache_mib: expected 1 to 1048576 MiB");
  switch (options.encryption) {
    case Encryption::any_certificate:
    case Encryption::authorities:
      return {};
    case Encryption::none:
      break;
    default:
      return failure("encryption: unknown value");
  }
  if (!options.password.empty())
    return failure("password: it is sent over encrypted connections only");
  return {};
}

Result<std::optional<TlsContext>, std::string> tls_of(const WorldClientOptions& options) {
  if (options.encryption == Encryption::none) return std::optional<TlsContext>();
  if (options.encryption == Encryption::any_certificate) return std::optional(TlsContext::client());
  auto context = TlsContext::client_of_authorities(options.authorities_file);
  if (!context) return failure(context.error());
  return std::optional(*std::move(context));
}

/// Throws std::runtime_error if the key file cannot be read or made.
KeyPair keys_of(const WorldClientOptions& options) {
  if (!options.key_file.empty()) return load_or_create_key(options.key_file);
  const KeyPair random = random_key();  // starts libsodium
  return options.key_seed ? key_pair_of(*options.key_seed) : random;
}

}  // namespace

Result<std::unique_ptr<JoinedSession>, std::string> JoinedSession::start(
    const WorldClientOptions& options, std::function<void()> wake) {
  if (const auto right = check_options(options); !right) return failure(right.error());
  auto address = addresses_of(options);
  if (!address) return failure(address.error());
  const bool is_kept = !options.key_file.empty() || options.key_seed;
  if (!address->ticket.empty() && !is_kept)
    return failure("invite: it is for an identity that is kept; give key_file or key_seed");
  auto tls = tls_of(options);
  if (!tls) return failure(tls.error());

  SessionConfig config;
  config.keys = keys_of(options);
  if (!options.key_file.empty()) config.pinned = load_pinned_servers(options.key_file);
  config.name = options.name;
  config.instance = random_instance();
  config.features = kFeaturesKnown & ~kUnusedFeatures;
  if (is_kept) config.features |= kFeatureNames;
  config.view.radius_h = options.view_radius;
  config.view.radius_v = options.view_radius_vertical;
  config.ticket = std::move(address->ticket);
  if (!options.password.empty()) config.password = std::make_shared<PasswordKeys>(options.password);
  config.has_cache = !options.cache_folder.empty();

  std::unique_ptr<CacheThread> cache;
  std::string warning;
  if (config.has_cache) {
    auto opened = ChunkCache::open(options.cache_folder, options.cache_mib << 20);
    if (!opened) return failure(opened.error());
    warning = (*opened)->take_warning();
    cache = std::make_unique<CacheThread>(*std::move(opened), nullptr, wake);
  }

  LinkConfig net;
  net.host = address->servers.front().host;
  net.port = address->servers.front().port;
  net.more.assign(address->servers.begin() + 1, address->servers.end());
  net.tls = *std::move(tls);
  std::unique_ptr<JoinedSession> joined(new JoinedSession(
      options.key_file, std::move(config), std::move(cache), std::move(net), std::move(wake)));
  if (!warning.empty()) joined->reports_.emplace_back(ClientWarning{std::move(warning)});
  return joined;
}

JoinedSession::JoinedSession(std::string key_file, SessionConfig config,
                             std::unique_ptr<CacheThread> cache, LinkConfig net,
                             std::function<void()> wake)
    : key_file_(std::move(key_file)),
      cache_(std::move(cache)),
      session_(std::move(config)),
      pins_kept_(session_.pinned().size()),
      net_(std::make_unique<NetClient>(std::move(net), std::move(wake))) {}

JoinedSession::~JoinedSession() = default;

void JoinedSession::receive() {
  if (is_ended_) return;
  if (events_.empty()) {
    for (LinkEvent& event : net_->take_events()) events_.push_back(std::move(event));
  }
  for (const TimeUs until_us = steady_now_us() + kReceiveUsMax;
       !events_.empty() && steady_now_us() < until_us && !is_ended_;) {
    LinkEvent event = std::move(events_.front());
    events_.pop_front();
    handle(std::move(event));
  }
}

void JoinedSession::handle(LinkEvent event) {
  if (const auto* connected = std::get_if<LinkConnected>(&event)) on_connected(*connected);
  if (const auto* gone = std::get_if<LinkDisconnected>(&event)) on_disconnected(*gone);
  if (auto* received = std::get_if<LinkReceived>(&event)) on_received(*received);
}

void JoinedSession::on_connected(const LinkConnected& event) {
  connection_ = event.connection;
  session_.connected(random_nonce(), event.binding, steady_now_us(), event.is_listed);
  flush();
}

void JoinedSession::on_received(LinkReceived& event) {
  if (event.connection != connection_) return;
  session_.receive(std::move(event.message),
                   {event.received_us, event.unpacked_us, steady_now_us()});
  if (std::exchange(servers_seen_, session_.servers_number()) != session_.servers_number())
    net_->set_servers(session_.servers());
  if (session_.connect_count() != connects_handled_) on_world_opened();
}

void JoinedSession::on_world_opened() {
  connects_handled_ = session_.connect_count();
  loss_.reset();
  const WorldId& world = session_.welcome()->world_id;
  const bool is_another = std::exchange(world_, world) != world;
  reports_.emplace_back(WorldOpened{is_another, keep_first_contact()});
}

bool JoinedSession::keep_first_contact() {
  if (session_.pinned().size() == pins_kept_) return false;
  pins_kept_ = session_.pinned().size();
  if (key_file_.empty()) return true;
  try {
    save_pinned_servers(key_file_, session_.pinned());
  } catch (const std::runtime_error& error) {
    reports_.emplace_back(
        ClientWarning{std::string("the key of the server is not kept: ") + error.what()});
  }
  return true;
}

void JoinedSession::on_disconnected(const LinkDisconnected& event) {
  if (event.connection != 0 && event.connection != connection_) return;
  connection_ = 0;
  step_cache(steady_now_us(), 0);
  keep_all_chunks();
  session_.disconnected();
  report_loss(event);
  if (!session_.end() || !session_.end()->final) return;
  net_->stop(0);
  events_.clear();
  is_ended_ = true;
}

void JoinedSession::report_loss(const LinkDisconnected& event) {
  const auto& end = session_.end();
  FailureWords words = end ? words_of(*end) : words_of_link(event.why, to_string(event.server));
  ConnectionLost loss{std::move(words.headline), std::move(words.detail), end && end->final,
                      session_.lacks_password()};
  const bool is_known = loss_ && loss_->headline == loss.headline && loss_->detail == loss.detail &&
                        loss_->is_final == loss.is_final;
  if (is_known) return;
  loss_ = loss;
  reports_.emplace_back(std::move(loss));
  if (reports_.size() > kReportsMax) reports_.erase(reports_.begin());
}

std::vector<WorldEvent> JoinedSession::take_events() { return std::exchange(reports_, {}); }

void JoinedSession::flush() {
  if (is_ended_) return;
  for (const Message& message : session_.take_outgoing())
    net_->send(connection_, encode_message(message));
  if (session_.wants_close() && connection_ != 0) net_->close(connection_);
}

void JoinedSession::step_cache(TimeUs now_us, std::size_t room_bytes) {
  if (!cache_ || is_ended_) return;
  exchange_lookups(session_, *cache_, room_bytes, now_us);
  if (now_us - kept_us_ >= kKeepUs) {
    kept_us_ = now_us;
    static_cast<void>(keep_chunks(cache_->room()));
  }
  if (std::string warning = cache_->take_warning(); !warning.empty())
    reports_.emplace_back(ClientWarning{std::move(warning)});
}

bool JoinedSession::keep_chunks(std::size_t count_max) {
  const auto world = session_.cached_world();
  if (!cache_ || !world) return false;
  std::vector<KeyedChunk> batch = session_.replica().take_for_cache(count_max);
  if (batch.empty()) return false;
  cache_->keep(*world, std::move(batch));
  return true;
}

void JoinedSession::keep_all_chunks() {
  while (keep_chunks(SIZE_MAX)) {
  }
}

void JoinedSession::stop() {
  if (!is_ended_) {
    step_cache(steady_now_us(), 0);
    keep_all_chunks();
    session_.close(GoodbyeReason::closing, "");
    flush();
    is_ended_ = true;
  }
  cache_.reset();  // writes what waits, and lets other clients use the cache
  net_->stop(kGoodbyeMs);
  session_.disconnected();
}

}  // namespace runstone
