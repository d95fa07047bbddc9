#include "server/app/server.hpp"

#include <sodium.h>

#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>
#include <asio/thread_pool.hpp>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "common/os/file_lock.hpp"
#include "common/os/steady_clock.hpp"
#include "protocol/codec/handshake.hpp"
#include "protocol/codec/key_fingerprint.hpp"
#include "server/admin/control_socket.hpp"
#include "server/admin/server_address.hpp"
#include "server/runtime/encryption.hpp"
#include "server/runtime/logging.hpp"
#include "server/runtime/low_priority_threads.hpp"
#include "server/runtime/read_clocks.hpp"
#include "server/runtime/server_core.hpp"

namespace runstone {
namespace {

/// Logs what --accept-losses accepted, before anything else can fail.
void log_losses(const std::vector<std::string>& losses) {
  for (const std::string& loss : losses) logger("store").warn("LOST, and accepted: {}", loss);
  if (losses.empty()) {
    logger("store").warn("nothing is lost: start the server without --accept-losses from now on");
  }
}

/// Encrypts connections with this certificate or, if there is none, with one of the world's key.
void use_certificate(ServerCore& core, const std::optional<TlsContext>& certificate,
                     const OpenedWorld& world) {
  const KeySeed& own_key = world.store->meta().server_key_seed;
  core.set_tls(certificate ? *certificate : TlsContext::self_signed_server(own_key));
}

/// Returns the path at which the server answers questions of a gateway.
std::string status_path(const ServerConfig& config) { return config.gateway_socket + ".status"; }
/// Returns the path at which the server answers a gateway for the operators' page.
std::string page_path(const ServerConfig& config) { return config.gateway_socket + ".page"; }

/// Returns the address of the gateway in links for operators. Without the setting page_address it is
/// that of a gateway on this machine with its own settings.
std::string page_base(const ServerConfig& config) {
  std::string base =
      config.page_address.empty() ? std::string("http://127.0.0.1:8080") : config.page_address;
  while (base.ends_with('/')) base.pop_back();
  return base;
}

/// Makes the folder of a world whose rows are in a database, for its owner only, unless it exists, and
/// locks it as the folder of a world. So two servers do not share its chat and its control socket.
Result<FileLock, std::string> take_local_folder(const std::string& folder) {
  std::error_code error;
  if (std::filesystem::create_directories(folder, error))
    std::filesystem::permissions(folder, std::filesystem::perms::owner_all, error);
  if (error) return failure(folder + ": cannot be made: " + error.message());
  if (has_world(folder)) {
    return failure(folder +
                   ": holds a world of its own; with `store`, the folder must be another one");
  }
  auto lock = FileLock::take(folder + "/world.lock");
  if (lock) return *std::move(lock);
  return failure(folder + (lock.error().is_held ? ": another server uses this folder"
                                                : "/world.lock: " + lock.error().what));
}

// As long as a write waits for a database that does not answer (common/postgres).
constexpr std::chrono::milliseconds kAloneMin{15'000};

LeaseTerms lease_of(const ServerConfig& config) {
  LeaseTerms lease;
  lease.length = std::chrono::seconds(config.lease_s);
  // Another server owns the world by then, if any reaches the database. The players here go there.
  if (config.standby) lease.alone_max = std::max(kAloneMin, 3 * lease.length);
  return lease;
}

Result<void, std::string> can_listen_for_gateway(const ServerConfig& config) {
  if (config.gateway_socket.empty()) {
    if (config.operators_page)
      return failure("operators_page: the page needs the setting gateway_socket, for runstone-web");
    return {};
  }
  for (const std::string& path : {config.gateway_socket, status_path(config), page_path(config)}) {
    if (const auto can = can_listen_at_path(path); !can)
      return failure("gateway_socket = " + can.error());
  }
  const auto folder = std::filesystem::absolute(config.gateway_socket).parent_path();
  const auto world = std::filesystem::absolute(config.world).lexically_normal();
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored) && folder.lexically_normal() != world)
    return failure("gateway_socket = " + config.gateway_socket + ": there is no folder " +
                   folder.string());
  return {};
}

}  // namespace

// Members are destroyed in reverse order: the core before the objects that it refers to.
struct Server::Parts {
  ServerConfig config;
  FileLock local_lock;  // of the folder `world`, if the world is in a database
  OpenedWorld world;
  // The store that this server writes since it took the world over; null before. A server that has
  // owned the world since its start writes world.store.
  std::unique_ptr<Store> writer;
  asio::io_context io;
  std::optional<asio::executor_work_guard<asio::io_context::executor_type>> work;
  std::unique_ptr<asio::thread_pool> workers, decoders;
  std::vector<std::thread> io_threads;
  std::unique_ptr<ControlSocket> control;    // null if the folder's path is too long
  std::unique_ptr<ControlSocket> status;     // for a gateway; null if there is none
  std::shared_ptr<AccessTokenStore> tokens;  // of the operators' page; null: it is off
  std::unique_ptr<PageDesk> desk;            // null: as before
  std::unique_ptr<ControlSocket> page;       // null: as before
  std::unique_ptr<ServerCore> core;
  bool is_unclaimed = false;
  bool is_running = false;

  /// The store that has the lease. Requires that this server does not follow.
  Store& owned_store() { return writer ? *writer : *world.store; }
  /// Makes the core, and binds the addresses.
  Result<void, std::string> prepare(const std::optional<TlsContext>& certificate,
                                    std::function<void()> on_failure, OperatorActions actions) {
    workers = low_priority_threads(config.worker_threads);
    decoders = low_priority_threads(config.io_threads);
    if (config.operators_page) {
      std::string warning;
      auto opened = AccessTokenStore::open(config.world, warning);
      if (!opened) return failure(opened.error());
      if (!warning.empty()) logger("app").warn("{}", warning);
      tokens = *std::move(opened);
      const auto players = world.store->players();
      if (!players) return failure(players.error().message());
      const auto ended = tokens->end_of_others(*players, read_clocks().utc_us);
      if (!ended) return failure(ended.error());
      if (*ended > 0)
        logger("app").warn("{}: {} access tokens end: the log has other numbers for their owners",
                           config.world, *ended);
      actions.tokens = tokens;
      actions.page_base = page_base(config);
    }
    core =
        std::make_unique<ServerCore>(ServerThreads{io, *workers, *decoders}, config, *world.store,
                                     *world.generator, std::move(on_failure), std::move(actions));
    if (!config.insecure) use_certificate(*core, certificate, world);
    if (auto bound = core->listen(config.listen); !bound) return bound;
    if (config.gateway_socket.empty()) return {};
    const auto bound = core->listen_for_gateway(config.gateway_socket, config.gateway_group);
    if (!bound) return failure("gateway_socket: " + bound.error());
    return {};
  }
  /// Returns where other servers reach this one.
  std::string peer_address() const { return peer_address_of(config, core->port()); }
  /// Starts the threads and the sockets for questions and commands.
  Result<void, std::string> run() {
    if (!config.gateway_socket.empty()) {
      auto listening =
          ControlSocket::listen_at(io, status_path(config), config.gateway_group,
                                   [this](const std::string& question, CommandReply reply) {
                                     core->answer_gateway(question, std::move(reply));
                                   });
      if (!listening) return failure("gateway_socket = " + listening.error());
      status = *std::move(listening);
    }
    if (tokens) {
      desk = std::make_unique<PageDesk>(*tokens, *workers, config.world, core->page_server());
      auto listening = ControlSocket::listen_at(
          io, page_path(config), config.gateway_group,
          [this](const std::string& line, CommandReply reply) {
            desk->take(line, std::move(reply));
          },
          kPageLineBytesMax);
      if (!listening) return failure("gateway_socket = " + listening.error());
      page = *std::move(listening);
    }
    work.emplace(io.get_executor());
    core->start();
    auto listening = ControlSocket::listen(io, config.world,
                                           [this](const std::string& line, CommandReply reply) {
                                             core->command(line, std::move(reply));
                                           });
    if (listening) {
      control = *std::move(listening);
    } else {
      logger("app").warn("no control socket: {}", listening.error());
    }
    for (std::uint64_t i = 0; i < config.io_threads; ++i) {
      io_threads.emplace_back([this] { io.run(); });
    }
    is_running = true;
    return {};
  }
};

Server::Server(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Server::~Server() {
  if (parts_->is_running) stop();
}

Result<void, std::string> Server::can_start(const ServerConfig& config) {
  const auto address = can_listen(config.listen);
  if (!address) return failure(address.error());
  if (const auto allowed = may_listen_at(*address, config); !allowed)
    return failure(allowed.error());
  if (const auto certificate = configured_certificate(config); !certificate)
    return failure(certificate.error());
  return can_listen_for_gateway(config);
}

Result<std::unique_ptr<Server>, std::string> Server::start(const ServerConfig& config,
                                                           const WorldCreation& creation,
                                                           std::function<void()> on_failure,
                                                           OperatorActions actions,
                                                           bool accept_losses) {
  if (sodium_init() < 0) return failure("libsodium cannot start");
  // A start that fails must neither make a new world nor raise the epoch, so the address and the
  // certificate are checked first.
  if (const auto can = can_start(config); !can) return failure(can.error());
  const auto certificate = configured_certificate(config);
  if (!certificate) return failure(certificate.error());
  FileLock local_lock;
  if (!config.store.empty()) {
    auto taken = take_local_folder(config.world);
    if (!taken) return failure(taken.error());
    local_lock = *std::move(taken);
  }
  auto world = open_or_create_world(world_place(config), creation, accept_losses, lease_of(config));
  if (!world) return failure(world.error());
  if (accept_losses) log_losses(world->losses);
  auto parts = std::make_unique<Parts>();
  parts->config = config;
  parts->local_lock = std::move(local_lock);
  parts->world = *std::move(world);
  const auto prepared = parts->prepare(*certificate, std::move(on_failure), std::move(actions));
  if (!prepared) return failure(prepared.error());
  if (const auto recovered = parts->core->recover(); !recovered) return failure(recovered.error());
  parts->is_unclaimed = parts->core->is_unclaimed();
  const auto published = parts->world.store->publish_address(parts->peer_address());
  if (!published) return failure(published.error().message());
  if (const auto running = parts->run(); !running) return failure(running.error());
  if (!parts->world.is_new && creation != WorldCreation{}) {
    logger("app").warn("world={} exists: the flags that say how to make one are ignored",
                       config.world);
  }
  if (parts->world.is_readable_by_others) {
    logger("app").warn(
        "file={} can be read by other users, and with it the world's secret key: chmod 600 it",
        parts->world.store->file());
  }
  if (parts->world.is_new) {
    const GeneratorPin& pin = parts->world.store->meta().generator;
    logger("app").info("NEW WORLD: made world={} generator={} seed={}", config.world, pin.name,
                       pin.seed);
  }
  logger("app").info(
      "fingerprint={} of this world's key: players compare it at first contact",
      key_fingerprint(key_pair_of(parts->world.store->meta().server_key_seed).public_key));
  logger("app").info("listening port={} encryption={} world={} new={}", parts->core->port(),
                     config.insecure ? "none" : "tls", config.world, parts->world.is_new);
  return std::unique_ptr<Server>(new Server(std::move(parts)));
}

Result<std::unique_ptr<Server>, std::string> Server::follow(const ServerConfig& config,
                                                            std::function<void()> on_failure,
                                                            OperatorActions actions) {
  if (sodium_init() < 0) return failure("libsodium cannot start");
  if (const auto can = can_start(config); !can) return failure(can.error());
  const auto certificate = configured_certificate(config);
  if (!certificate) return failure(certificate.error());
  auto local_lock = take_local_folder(config.world);
  if (!local_lock) return failure(local_lock.error());
  auto store = open_world(world_place(config), StoreAccess::read_only);
  if (!store) return failure(store.error().message());
  auto generator = generator_of(**store);
  if (!generator) return failure(generator.error());
  auto parts = std::make_unique<Parts>();
  parts->config = config;
  parts->local_lock = *std::move(local_lock);
  parts->world.store = *std::move(store);
  parts->world.generator = *std::move(generator);
  const auto prepared = parts->prepare(*certificate, std::move(on_failure), std::move(actions));
  if (!prepared) return failure(prepared.error());
  if (const auto begun = parts->core->follow(); !begun) return failure(begun.error());
  if (const auto running = parts->run(); !running) return failure(running.error());
  logger("app").info("STANDBY: listening port={} encryption={} world={}", parts->core->port(),
                     config.insecure ? "none" : "tls", config.world);
  return std::unique_ptr<Server>(new Server(std::move(parts)));
}

void Server::connect_to(const std::string& owner) { parts_->core->connect_to(owner); }
ServerCore::FollowState Server::follow_state() const { return parts_->core->follow_state(); }
OwnershipState Server::ownership() const { return parts_->core->ownership(); }

Result<void, OwnershipError> Server::take_over() {
  Parts& parts = *parts_;
  LeaseTerms lease = lease_of(parts.config);
  lease.waits = false;  // if another server was faster, the players here wait for it
  auto writer = open_world(world_place(parts.config), StoreAccess::read_write, "", lease);
  if (!writer) return failure(OwnershipError{writer.error().message(), false});
  parts.writer = *std::move(writer);
  const auto taken = parts.core->take_over(*parts.writer, parts.peer_address());
  if (taken) return {};
  parts.writer->give_up();  // another server need not wait for the lease to run out
  return failure(OwnershipError{taken.error(), has_failed(ownership())});
}

Result<void, OwnershipError> Server::hand_over(std::optional<SessionId> successor) {
  Parts& parts = *parts_;
  const auto refused = [](std::string why) {
    return failure(OwnershipError{std::move(why), false});
  };
  if (!owns(ownership())) return refused("this server does not own the world");
  if (!parts.config.standby)
    return refused("a server that was started without --standby does not follow another one");
  const auto begun = parts.core->begin_handover(successor);
  if (!begun) return refused(begun.error());
  const auto ended = parts.core->end_handover();
  parts.owned_store().give_up();  // after an error, too: a follower may have the edits
  if (!ended) return failure(OwnershipError{ended.error(), has_failed(ownership())});
  parts.writer.reset();
  logger("app").info("HANDED OVER: server={} takes the world over, and this server follows it",
                     *begun);
  return {};
}

std::uint16_t Server::port() const { return parts_->core->port(); }
bool Server::is_unclaimed() const { return parts_->is_unclaimed; }
void Server::command(const std::string& line, CommandReply reply) {
  parts_->core->command(line, std::move(reply));
}
CommandAnswer Server::answer_of(const std::string& line) { return parts_->core->answer_of(line); }
void Server::reload(Result<ServerConfig, std::string> read, CommandReply reply) {
  if (read && !parts_->config.insecure) {
    // A certificate is renewed in the same file, so it is read whether a setting has changed or not.
    const auto certificate = configured_certificate(*read);
    if (certificate) {
      use_certificate(*parts_->core, *certificate, parts_->world);
      if (*certificate) logger("app").info("the certificate was read again");
    } else {
      read = failure(certificate.error());
    }
  }
  parts_->core->reload(std::move(read), std::move(reply));
}
void Server::log_counters() { parts_->core->log_counters(); }

StopReport Server::stop() {
  Parts& parts = *parts_;
  parts.is_running = false;
  if (parts.control) parts.control->stop();
  if (parts.status) parts.status->stop();
  if (parts.page) parts.page->stop();
  const TimeUs due_us =
      steady_now_us() + static_cast<TimeUs>(parts.config.stop_s) * std::int64_t{1'000'000};
  const bool successor_waits = parts.core->stop_world();
  parts.core->stop_writer();
  const bool is_owner = owns(ownership());
  const bool hands_over = is_owner && successor_waits;
  if (hands_over) {
    parts.owned_store().give_up();
    logger("app").info("HANDED OVER: another server takes the world over");
  }
  parts.workers->stop();  // nobody waits for the chunks that they have not begun
  parts.workers->join();
  parts.core->log_counters();
  parts.control.reset();  // closes connections that have not read their answer
  parts.status.reset();
  parts.page.reset();
  parts.work.reset();
  for (std::thread& thread : parts.io_threads) thread.join();
  parts.decoders->join();
  const StopState state = parts.core->stop_state();
  const auto live = parts.core->edited_chunks();
  parts.core.reset();
  if (!is_owner) return {};
  // Once the world is handed over, its rows are those of another server.
  StopReport report = sum_up(parts.owned_store(), live, state, [due_us, hands_over] {
    return !hands_over && steady_now_us() < due_us;
  });
  report.hands_over = hands_over;
  if (!hands_over) {
    if (const auto complete = parts.owned_store().complete_file(); !complete)
      logger("store").warn("{}", complete.error().message());
  }
  return report;
}

}  // namespace runstone
