// ControlSocket: receives commands from other programs of the same user, through a Unix domain
// socket in the world's folder ("control.sock", mode 0600, removed when the server stops). A
// command is one line of text. The answer is lines that begin with "|", followed by "=ok" or
// "=error". After "=unsaved" instead, the command is in force and not on disk yet, and the server
// closes the connection. A connection may send several commands, one after another. Thread:
// everything runs on one strand of the I/O context. The handler is called there; it may reply from
// any thread.
#pragma once
#include <asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>

#include "common/core/result.hpp"
#include "protocol/limits.hpp"
#include "server/rollback/rollback_service.hpp"

namespace runstone {

inline constexpr const char* kControlSocketName = "control.sock";

/// Returns the path of the socket in a world's folder. Fails if the path is too long for a socket.
Result<std::string, std::string> control_path(const std::string& world);

class ControlSocket {
 public:
  /// Carries out one line. The reply may be called from any thread; the last call has is_done.
  using Handler = std::function<void(const std::string& line, CommandReply reply)>;

  /// Starts listening. Requires the world's lock; a socket that exists was then left by a server
  /// that crashed, and is replaced. Fails if the path is too long or the folder cannot be written.
  static Result<std::unique_ptr<ControlSocket>, std::string> listen(asio::io_context& io,
                                                                    const std::string& world,
                                                                    Handler handler);
  /// Starts listening at any path, with the mode 0660 if `is_for_group`. Requires that no program
  /// listens there, and that a file there is a socket. A connection with a longer line than
  /// `line_bytes_max` ends. Fails if the path is too long or the folder cannot be written.
  static Result<std::unique_ptr<ControlSocket>, std::string> listen_at(
      asio::io_context& io, const std::string& path, bool is_for_group, Handler handler,
      std::size_t line_bytes_max = kCommandBytesMax);
  /// Stops, and closes all connections, even those that wait for an answer.
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  /// Accepts no more connections and removes the file. Each connection is closed after the answer
  /// it waits for.
  void stop();

 private:
  struct Parts;
  explicit ControlSocket(std::shared_ptr<Parts> parts);
  std::shared_ptr<Parts> parts_;
  bool is_stopped_ = false;
};

}  // namespace runstone
