// ControlSocket: takes commands from other programs of the same user, through a Unix domain socket in the world's
// folder ("control.sock", mode 0600, gone when the server stops). One text line in; the answer is lines that
// begin with "|", and last "=ok" or "=error". A connection may give several commands, one after another.
// Threads: all on one strand of the I/O context; the handler is called there, its replies may come from any.
#pragma once
#include <asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>

#include "common/core/result.hpp"
#include "server/rollback/rollback_service.hpp"

namespace runstone {

inline constexpr const char* kControlSocketName = "control.sock";

/// The socket's path in a world's folder; an error if a socket cannot have so long a path.
Result<std::string, std::string> control_path(const std::string& world);

class ControlSocket {
 public:
  /// Carries out one line; the reply may be called from any thread, the last time with is_done.
  using Handler = std::function<void(const std::string& line, CommandReply reply)>;

  /// Replaces a socket that a server which died left behind: the caller holds the world's lock, so nobody else
  /// listens. Fails if the path is too long or the folder cannot be written.
  static Result<std::unique_ptr<ControlSocket>, std::string> listen(asio::io_context& io,
                                                                    const std::string& world,
                                                                    Handler handler);
  /// stop(), and closes the connections that are left, whatever they wait for.
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  /// Takes no more connections and removes the file. Connections end, those that wait for an answer once they have it.
  void stop();

 private:
  struct Parts;
  explicit ControlSocket(std::shared_ptr<Parts> parts);
  std::shared_ptr<Parts> parts_;
  bool is_stopped_ = false;
};

}  // namespace runstone
