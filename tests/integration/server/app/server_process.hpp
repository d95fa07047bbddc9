// ServerProcess: a server in another process, which can be killed.
#pragma once
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <asio/io_context.hpp>
#include <asio/posix/stream_descriptor.hpp>
#include <asio/post.hpp>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "server/app/standby.hpp"
#include "tests/integration/server/app/server_bench.hpp"

namespace runstone::test {

class ServerProcess {
 public:
  /// Starts a server and waits until it has a port or has ended. `config` is called in the new
  /// process. Requires that this process has no second thread: a lock that such a thread holds at
  /// the fork stays locked in the child. So only the child starts to log.
  explicit ServerProcess(const std::function<ServerConfig()>& config) {
    int ends[2];
    REQUIRE(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) == 0);
    child_ = ::fork();
    REQUIRE(child_ >= 0);
    if (child_ == 0) {
      ::close(ends[0]);
      ::_exit(run(config, ends[1]));
    }
    ::close(ends[1]);  // so that the wait for the port ends if the child ends
    parent_end_ = ends[0];
    pollfd port_is_known{parent_end_, POLLIN, 0};
    if (::poll(&port_is_known, 1, kStartMs) <= 0 ||
        ::read(parent_end_, &port_, sizeof port_) != static_cast<ssize_t>(sizeof port_)) {
      port_ = 0;
    }
  }
  ~ServerProcess() { kill(); }
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  /// Returns 0 if the server did not start.
  std::uint16_t port() const { return port_; }
  /// Returns how a server that did not start ended. Call it at most once, and not after kill().
  std::string failure() {
    int status = 0;
    if (::waitpid(child_, &status, WNOHANG) == 0) return "it runs, but did not listen in time";
    ::close(parent_end_);
    child_ = -1;
    return WIFSIGNALED(status) ? "signal " + std::to_string(WTERMSIG(status))
                               : "exit code " + std::to_string(WEXITSTATUS(status));
  }
  /// Stops the process as a frozen machine, and lets it go on.
  void pause() { ::kill(child_, SIGSTOP); }
  void resume() { ::kill(child_, SIGCONT); }
  /// Waits until the server ends by itself. Returns true if its log had failed. Call it at most
  /// once.
  bool fails() { return wait() != 0; }
  /// Kills the process as `kill -9` does. It may be called again.
  void kill() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    wait();
  }
  /// Stops the server in order. Returns true if every edit is in the log. Call it at most once.
  bool stop() {
    ::shutdown(parent_end_, SHUT_WR);
    return wait() == 0;
  }

 private:
  static constexpr int kStartMs = 300'000;  // also beside many other programs

  /// Runs a server in the child until the parent ends or closes its end of the socket. Returns the
  /// child's exit code.
  static int run(const std::function<ServerConfig()>& config, int socket) {
    const ServerConfig values = config();
    start_logging(values.log_level);
    // A server that has failed ends as if the parent had asked for it.
    const auto on_failure = [socket] { ::shutdown(socket, SHUT_RD); };
    asio::io_context loop;
    asio::posix::stream_descriptor end(loop, socket);
    std::unique_ptr<Server> running;
    std::optional<TakeoverWatch> watch;
    bool has_failed = false;
    OperatorActions actions;
    actions.hand_over = [&](std::optional<SessionId> successor, CommandReply reply) {
      asio::post(loop, [&, successor, reply = std::move(reply)] {
        if (hand_over_and_watch(values.store, *running, watch, on_failure, successor, reply))
          return;
        has_failed = true;
        loop.stop();
      });
    };
    const auto start = [&] { return Server::start(values, flat_creation(), on_failure, actions); };
    const auto stops_within = [](std::chrono::milliseconds time) {
      std::this_thread::sleep_for(time);
      return false;
    };
    const auto follow = [&] { return Server::follow(values, on_failure, actions); };
    auto server =
        values.standby ? start_as_standby(values.store, stops_within, start, follow) : start();
    if (!server) {
      std::fprintf(stderr, "%s\n", server.error().c_str());
      return 1;
    }
    running = *std::move(server);
    const std::uint16_t port = running->port();
    if (::write(socket, &port, sizeof port) != static_cast<ssize_t>(sizeof port)) return 1;
    if (!owns(running->ownership())) watch.emplace(values.store, *running, on_failure);
    end.async_wait(asio::posix::stream_descriptor::wait_read,
                   [&](const asio::error_code& /*error*/) { loop.stop(); });
    loop.run();
    watch.reset();
    return running->stop().state.is_durable() && !has_failed ? 0 : 1;
  }

  /// Waits until the child has ended, and returns its status.
  int wait() {
    int status = 0;
    ::waitpid(child_, &status, 0);
    ::close(parent_end_);
    child_ = -1;
    return status;
  }

  pid_t child_ = -1;
  int parent_end_ = -1;
  std::uint16_t port_ = 0;
};

}  // namespace runstone::test
