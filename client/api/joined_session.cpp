#include "client/api/joined_session.hpp"

#include <stdexcept>
#include <utility>

#include "client/net/key_file.hpp"
#include "client/session/failure_words.hpp"
#include "client/session/join_check.hpp"
#include "common/os/host_port.hpp"
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
    kFeatureNames | kFeatureKeyTransfer | kFeatureTextures | kFeaturePreviews | kFeatureStrokes;

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

  std::unique_ptr<CacheThread> cache;
  std::string warning;
  if (!options.cache_folder.empty()) {
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
  std::unique_ptr<JoinedSession> joined(
      new JoinedSession(options.key_file, std::move(config), std::move(cache)));
  if (!warning.empty()) joined->on_cache_warning(std::move(warning));
  joined->threads_.connect(std::move(net), std::move(wake));
  return joined;
}

JoinedSession::JoinedSession(std::string key_file, SessionConfig config,
                             std::unique_ptr<CacheThread> cache)
    : key_file_(std::move(key_file)),
      pins_kept_(config.pinned.size()),
      threads_(std::move(config), std::move(cache), *this) {}

JoinedSession::~JoinedSession() = default;

void JoinedSession::receive() {
  if (!is_ended_) threads_.receive();
}

void JoinedSession::on_world_opened() {
  loss_.reset();
  const WorldId& world = session().welcome()->world_id;
  const bool is_another = std::exchange(world_, world) != world;
  reports_.emplace_back(WorldOpened{is_another, keep_first_contact()});
}

bool JoinedSession::keep_first_contact() {
  const auto& pinned = session().pinned();
  if (pinned.size() == pins_kept_) return false;
  pins_kept_ = pinned.size();
  if (key_file_.empty()) return true;
  try {
    save_pinned_servers(key_file_, pinned);
  } catch (const std::runtime_error& error) {
    reports_.emplace_back(
        ClientWarning{std::string("the key of the server is not kept: ") + error.what()});
  }
  return true;
}

void JoinedSession::on_connection_lost(const LinkDisconnected& event) {
  const auto& end = session().end();
  FailureWords words = end ? words_of(*end) : words_of_link(event.why, to_string(event.server));
  ConnectionLost loss{std::move(words.headline), std::move(words.detail), end && end->final,
                      session().lacks_password()};
  if (loss.is_final) {
    threads_.disconnect();
    is_ended_ = true;
  }
  const bool is_known = loss_ && loss_->headline == loss.headline && loss_->detail == loss.detail &&
                        loss_->is_final == loss.is_final;
  if (is_known) return;
  loss_ = loss;
  reports_.emplace_back(std::move(loss));
  if (reports_.size() > kReportsMax) reports_.erase(reports_.begin());
}

void JoinedSession::on_cache_warning(std::string warning) {
  reports_.emplace_back(ClientWarning{std::move(warning)});
}

std::vector<WorldEvent> JoinedSession::take_events() { return std::exchange(reports_, {}); }

void JoinedSession::flush() {
  if (!is_ended_) threads_.flush();
}

void JoinedSession::step_cache(TimeUs now_us, std::size_t room_bytes) {
  if (!is_ended_) threads_.step_cache(now_us, room_bytes);
}

void JoinedSession::stop() {
  if (!is_ended_) {
    threads_.finish();
    session().disconnected();
    is_ended_ = true;
  }
  threads_.release_cache();
}

}  // namespace runstone
