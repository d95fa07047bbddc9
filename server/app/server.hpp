// Server: a whole Runstone server in this process: world, threads, sockets. The program runs
// one, tests run several. Requires start_logging().
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/core/result.hpp"
#include "server/admin/operator_actions.hpp"
#include "server/admin/server_config.hpp"
#include "server/app/stop_report.hpp"
#include "server/rollback/rollback_service.hpp"
#include "server/runtime/server_core.hpp"
#include "server/store/world_folder.hpp"
#include "server/world/order/ownership.hpp"

namespace runstone {

/// Why a server did not take the world over, or did not hand it over.
struct OwnershipError {
  std::string what;  // a sentence
  // has_failed(ownership()): the server can neither own the world nor follow its owner any more,
  // and has to be stopped. Otherwise nothing has changed.
  bool must_stop = false;
};

class Server {
 public:
  /// Returns why a server with these settings cannot start, as far as that shows before the world
  /// is opened.
  static Result<void, std::string> can_start(const ServerConfig& config);
  /// Opens or makes the world, binds the port, recovers, and runs. The error is one line for the
  /// operator; after an error nothing was overwritten. `on_failure` is called once, from another
  /// thread, if the log cannot be written any more; the caller then stops the server. `actions` are
  /// called from another thread when an operator gives their commands; their replies must end
  /// before the server is destroyed. `accept_losses`: a world that has lost edits, players or
  /// watermarks is repaired, and each loss is logged.
  static Result<std::unique_ptr<Server>, std::string> start(
      const ServerConfig& config, const WorldCreation& creation,
      std::function<void()> on_failure = [] {}, OperatorActions actions = {},
      bool accept_losses = false);
  /// Opens the world for reading, binds the port, and follows the server that owns the world: it
  /// serves players as well, as docs/cluster.md says. Requires a world in a database. The arguments
  /// are as for start(). Call connect_to() as long as it follows, until take_over().
  static Result<std::unique_ptr<Server>, std::string> follow(const ServerConfig& config,
                                                             std::function<void()> on_failure,
                                                             OperatorActions actions);
  /// Calls stop() unless it was called.
  ~Server();

  std::uint16_t port() const;
  /// Returns true if before this start no role was ever granted and no invite ever made, as in a
  /// new or an imported world.
  bool is_unclaimed() const;
  /// Connects a server that follows to the owner at HOST:PORT, unless it is connected.
  void connect_to(const std::string& owner);
  /// Returns the state of the connection with the owner, for a server that follows.
  ServerCore::FollowState follow_state() const;
  /// Takes the lease of the world, and makes a server that follows its owner. Players stay. Blocks
  /// on the database. Requires that it follows.
  Result<void, OwnershipError> take_over();
  /// Lets another server take the world over, and makes the owner a server that follows. Players
  /// stay. `successor` is as for Cluster::hand_over(). Blocks on the database. Call connect_to()
  /// afterwards as long as it follows.
  Result<void, OwnershipError> hand_over(std::optional<SessionId> successor);
  /// Returns the part that this server plays in its world. Thread: any.
  OwnershipState ownership() const;
  void log_counters();
  /// Carries out a command as an operator. Replies come from another thread; the last one has
  /// is_done. A server that stops may leave out replies.
  void command(const std::string& line, CommandReply reply);
  /// Carries out a command as an operator, and returns its last answer. Blocks until the world
  /// strand has answered.
  CommandAnswer answer_of(const std::string& line);
  /// Takes over the settings of `read` that a running server may change, or reports why there are
  /// none. The reply comes from another thread.
  void reload(Result<ServerConfig, std::string> read, CommandReply reply);
  /// Sends a goodbye to all sessions, waits for the log, writes snapshots for at most `stop_s`, and
  /// ends all threads. Blocks. Call it once.
  StopReport stop();

 private:
  struct Parts;
  explicit Server(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace runstone
