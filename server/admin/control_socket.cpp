#include "server/admin/control_socket.hpp"

#include <sys/stat.h>
#include <sys/un.h>

#include <asio/bind_executor.hpp>
#include <asio/local/stream_protocol.hpp>
#include <asio/post.hpp>
#include <asio/read_until.hpp>
#include <asio/steady_timer.hpp>
#include <asio/strand.hpp>
#include <asio/write.hpp>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <filesystem>
#include <utility>
#include <vector>

#include "protocol/limits.hpp"

namespace runstone {
namespace {

using Strand = asio::strand<asio::io_context::executor_type>;
using Local = asio::local::stream_protocol;

constexpr std::size_t kConnectionsMax = 16;
constexpr auto kRetryInterval = std::chrono::milliseconds(200);
constexpr std::size_t kPathBytesMax = sizeof(sockaddr_un::sun_path) - 1;

/// One connection. It reads a line, passes it to the handler, writes the answer, and reads the next
/// line.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Local::socket socket, Strand strand, ControlSocket::Handler handler,
             std::shared_ptr<int> slot, std::size_t line_bytes_max)
      : socket_(std::move(socket)),
        strand_(std::move(strand)),
        handler_(std::move(handler)),
        slot_(std::move(slot)),
        line_bytes_max_(line_bytes_max) {}

  /// Reads no more lines, and closes once the current answer is written. Thread: the strand, as for
  /// all calls.
  void finish() {
    is_finishing_ = true;
    if (!is_busy_) close();
  }
  void close() {
    asio::error_code ignored;
    socket_.close(ignored);
    slot_.reset();  // the command may go on, and keeps this object
  }

  void read() {
    asio::async_read_until(
        socket_, asio::dynamic_buffer(in_, line_bytes_max_ + 1), '\n',
        asio::bind_executor(
            strand_, [self = shared_from_this()](const asio::error_code& error, std::size_t bytes) {
              if (error) return;  // the peer closed, or the line is too long
              const std::string line = self->in_.substr(0, bytes - 1);
              self->in_.erase(0, bytes);
              self->is_busy_ = true;
              self->handler_(line, [self](const CommandAnswer& answer) {
                asio::post(self->strand_, [self, answer] { self->answer(answer); });
              });
            }));
  }

 private:
  void answer(const CommandAnswer& answer) {
    if (!socket_.is_open()) return;
    std::string out;
    for (std::size_t at = 0; at <= answer.text.size();) {
      const std::size_t end = std::min(answer.text.find('\n', at), answer.text.size());
      out += "|" + answer.text.substr(at, end - at) + "\n";
      at = end + 1;
    }
    if (answer.is_done) out += answer.is_ok ? "=ok\n" : "=error\n";
    if (answer.is_unsaved) {
      out += "=unsaved\n";
      is_finishing_ = true;
    }
    is_done_ = answer.is_done || answer.is_unsaved;
    out_.push_back(std::move(out));
    if (out_.size() == 1) write();
  }

  void write() {
    asio::async_write(
        socket_, asio::buffer(out_.front()),
        asio::bind_executor(strand_, [self = shared_from_this()](const asio::error_code& error,
                                                                 std::size_t /*bytes*/) {
          if (error) return;
          self->out_.pop_front();
          if (!self->out_.empty()) return self->write();
          if (!std::exchange(self->is_done_, false)) return;
          self->is_busy_ = false;
          self->is_finishing_ ? self->close() : self->read();
        }));
  }

  Local::socket socket_;
  Strand strand_;
  ControlSocket::Handler handler_;
  std::shared_ptr<int> slot_;  // counts the connections by its references
  const std::size_t line_bytes_max_;
  std::string in_;
  std::deque<std::string> out_;
  bool is_done_ = false;       // out_ holds the last answer to the line
  bool is_busy_ = false;       // a line is being carried out or answered
  bool is_finishing_ = false;  // the server stops
};

}  // namespace

struct ControlSocket::Parts : std::enable_shared_from_this<Parts> {
  Parts(asio::io_context& io, std::string path_, Handler handler_, std::size_t line_bytes_max_)
      : strand(asio::make_strand(io)),
        acceptor(io),
        retry(io),
        path(std::move(path_)),
        handler(std::move(handler_)),
        line_bytes_max(line_bytes_max_) {}

  void accept() {
    acceptor.async_accept(asio::bind_executor(
        strand, [self = shared_from_this()](const asio::error_code& error, Local::socket socket) {
          // A connection may have come just before stop() closed the acceptor.
          if (error == asio::error::operation_aborted || !self->acceptor.is_open()) return;
          if (error) return self->accept_later();  // for example, too many open files
          // The maximum number of connections. A user needs no more at a time, so further ones are
          // closed.
          if (self->slots.use_count() <= static_cast<long>(kConnectionsMax)) {
            const auto connection = std::make_shared<Connection>(
                std::move(socket), self->strand, self->handler, self->slots, self->line_bytes_max);
            std::erase_if(self->connections, [](const auto& gone) { return gone.expired(); });
            self->connections.push_back(connection);
            connection->read();
          }
          self->accept();
        }));
  }

  void accept_later() {
    retry.expires_after(kRetryInterval);
    retry.async_wait(
        asio::bind_executor(strand, [self = shared_from_this()](const asio::error_code& error) {
          if (!error) self->accept();
        }));
  }

  Strand strand;
  Local::acceptor acceptor;
  asio::steady_timer retry;
  std::vector<std::weak_ptr<Connection>> connections;
  std::string path;
  Handler handler;
  const std::size_t line_bytes_max;
  std::shared_ptr<int> slots = std::make_shared<int>(0);
};

Result<std::string, std::string> control_path(const std::string& world) {
  const std::string path = (std::filesystem::path(world) / kControlSocketName).string();
  if (path.size() <= kPathBytesMax) return path;
  return failure(path + ": a socket's path has at most " + std::to_string(kPathBytesMax) +
                 " bytes: use a shorter or a relative path to the world");
}

ControlSocket::ControlSocket(std::shared_ptr<Parts> parts) : parts_(std::move(parts)) {}
ControlSocket::~ControlSocket() {
  stop();
  asio::post(parts_->strand, [parts = parts_] {
    for (const auto& weak : parts->connections) {
      if (const auto connection = weak.lock()) connection->close();
    }
  });
}

Result<std::unique_ptr<ControlSocket>, std::string> ControlSocket::listen(asio::io_context& io,
                                                                          const std::string& world,
                                                                          Handler handler) {
  auto path = control_path(world);
  if (!path) return failure(path.error());
  return listen_at(io, *path, false, std::move(handler));
}

Result<std::unique_ptr<ControlSocket>, std::string> ControlSocket::listen_at(
    asio::io_context& io, const std::string& path, bool is_for_group, Handler handler,
    std::size_t line_bytes_max) {
  auto parts = std::make_shared<Parts>(io, path, std::move(handler), line_bytes_max);
  std::error_code ignored;
  if (std::filesystem::is_socket(path, ignored)) std::filesystem::remove(path, ignored);
  asio::error_code error;
  parts->acceptor.open(Local(), error);
  if (!error) parts->acceptor.bind(Local::endpoint(path), error);
  // Nobody can connect before listen(), so the mode takes effect in time.
  const mode_t mode = S_IRUSR | S_IWUSR | (is_for_group ? S_IRGRP | S_IWGRP : 0);
  if (!error && ::chmod(path.c_str(), mode) != 0) {
    error = asio::error_code(errno, asio::error::get_system_category());
  }
  if (!error) parts->acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) return failure(path + ": " + error.message());
  parts->accept();
  return std::unique_ptr<ControlSocket>(new ControlSocket(std::move(parts)));
}

void ControlSocket::stop() {
  if (std::exchange(is_stopped_, true)) return;
  asio::post(parts_->strand, [parts = parts_] {
    asio::error_code ignored;
    parts->acceptor.close(ignored);
    parts->retry.cancel();
    for (const auto& weak : parts->connections) {
      if (const auto connection = weak.lock()) connection->finish();
    }
  });
  std::error_code ignored;
  std::filesystem::remove(parts_->path, ignored);
}

}  // namespace runstone
