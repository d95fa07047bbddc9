// LocalServer: a runstone-server on this computer that runs a world of the player while the client
// plays in it. It listens on the loopback address alone. It ends in order when the client closes
// its standard input, which the system does too if the client is killed.
// Thread: one. No call waits, except stop() and the destructor.
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// The rules of a world that does not exist yet.
struct NewLocalWorld {
  std::string generator = "landscape";  // landscape, terrain, flat or empty
  std::optional<std::uint64_t> seed;    // nullopt: a random one
  friend bool operator==(const NewLocalWorld&, const NewLocalWorld&) = default;
};

struct LocalServerConfig {
  std::string folder;                     // of the world
  std::optional<NewLocalWorld> creation;  // nullopt: the folder must hold a world
  PublicKey player{};                     // may give every command
  std::string program;                    // empty: local_server_program()
};

/// Returns the environment variable RUNSTONE_SERVER if it is set, otherwise `runstone-server`
/// beside this program if it is there, otherwise the bare name, which is searched on PATH.
std::string local_server_program();

class LocalServer {
 public:
  enum class State : std::uint8_t { starting, running, ended };

  /// Starts the server. The standard output and error of the server go to the file `server.log` in
  /// the folder of the world. Fails with a line of text if the folder holds no world and none may
  /// be made, or if the program cannot be started.
  static Result<std::unique_ptr<LocalServer>, std::string> start(const LocalServerConfig& config);
  /// Calls stop().
  ~LocalServer();
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;

  /// Looks whether the server listens or has ended. Cost: two system calls.
  State poll();
  /// Returns the port on 127.0.0.1. Requires that poll() has returned `running`.
  std::uint16_t port() const { return port_; }
  /// Returns why the server has ended, or an empty text if it ended in order after request_stop().
  /// Requires that poll() has returned `ended`.
  const std::string& failure_text() const { return failure_; }
  /// Asks the server to end. It first makes all edits durable. poll() returns `ended` afterwards.
  void request_stop();
  /// Asks the server to end, and waits until it has. A server that needs longer than kStopMs is
  /// killed: the next start takes its edits from the log.
  void stop();

  static constexpr std::int64_t kStopMs = 30'000;

 private:
  LocalServer(pid_t pid, int input, std::string folder)
      : pid_(pid), input_(input), folder_(std::move(folder)) {}
  void on_ended(int status);

  pid_t pid_;  // -1 after the end
  int input_;  // the end of the pipe that is the server's standard input; -1 after request_stop()
  std::string folder_;
  std::uint16_t port_ = 0;
  State state_ = State::starting;
  std::string failure_;
};

}  // namespace runstone
