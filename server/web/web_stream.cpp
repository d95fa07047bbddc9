#include "server/web/web_stream.hpp"

#include <sys/socket.h>

#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cerrno>

namespace runstone {
namespace {

// Bytes of TLS records that are read before others get their turn.
constexpr std::size_t kReadBytesMax = 64 * 1024;
// Room for output that a connection keeps while nothing is unsent.
constexpr std::size_t kKeptBytesMax = 4 * 1024;

}  // namespace

WebStream::WebStream(Socket socket, const TlsContext* context) : socket_(std::move(socket)) {
  ErrorCode ignored;
  socket_.non_blocking(true, ignored);
  if (context == nullptr) return;
  source_ = SocketSource(socket_.native_handle());
  tls_.emplace(TlsChannel::accept(*context, source_));
}

boost::asio::awaitable<bool> WebStream::handshake(WebStream& stream) {
  while (stream.tls_ && !stream.is_secure_) {
    if (!stream.is_open_) co_return false;
    stream.source_.allow(kReadBytesMax);
    const TlsChannel::Status status = stream.tls_->handshake();
    const bool is_sent = stream.send_now();  // also what tells the browser of a failure
    stream.is_secure_ = status == TlsChannel::Status::done;
    const bool is_over = stream.source_.is_at_end() || stream.source_.error();
    if (stream.is_secure_) break;
    if (status != TlsChannel::Status::wants_input || is_over || !is_sent) co_return false;
    ErrorCode error;
    // The browser waits for what is unsent before it sends more.
    const auto event = stream.has_unsent() ? Socket::wait_write : Socket::wait_read;
    co_await stream.socket_.async_wait(
        event, boost::asio::redirect_error(boost::asio::use_awaitable, error));
    if (error) co_return false;
  }
  co_return true;
}

std::size_t WebStream::read_now(boost::asio::mutable_buffer into, ErrorCode& error) {
  error = boost::asio::error::eof;
  if (!is_open_) return 0;
  if (!tls_) {
    const ssize_t got = ::recv(socket_.native_handle(), into.data(), into.size(), MSG_DONTWAIT);
    if (got > 0) error = {};
    if (got < 0) error = {errno, boost::system::system_category()};
    // Linux has one number for both, and Boost compares categories.
    if (got < 0 && errno == EAGAIN) error = boost::asio::error::would_block;
    return got > 0 ? static_cast<std::size_t>(got) : 0;
  }
  std::size_t bytes = 0;
  source_.allow(kReadBytesMax);
  const TlsChannel::Status status =
      tls_->read({static_cast<std::uint8_t*>(into.data()), into.size()}, bytes);
  if (has_unsent() && !send_now()) return 0;
  if (status == TlsChannel::Status::done) error = {};
  const bool is_over = source_.is_at_end() || source_.error();
  if (status == TlsChannel::Status::wants_input && !is_over)
    error = boost::asio::error::would_block;
  return bytes;
}

bool WebStream::write_now(ByteView bytes) {
  if (!is_open_) return false;
  if (!tls_) {
    plain_output_.insert(plain_output_.end(), bytes.begin(), bytes.end());
  } else if (!tls_->write(bytes)) {
    is_open_ = false;
    return false;
  }
  return send_now();
}

bool WebStream::send_now() {
  if (!is_open_) return false;
  Bytes& unsent = output();
  while (sent_ < unsent.size()) {
    const ssize_t count = ::send(socket_.native_handle(), unsent.data() + sent_,
                                 unsent.size() - sent_, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return true;
    if (count < 0) {
      is_open_ = false;
      return false;
    }
    sent_ += static_cast<std::size_t>(count);
  }
  sent_ = 0;
  unsent.clear();
  if (unsent.capacity() > kKeptBytesMax) Bytes().swap(unsent);
  return true;
}

void WebStream::end_sending() {
  if (!is_open_) return;
  if (is_secure_) tls_->end();
  static_cast<void>(send_now());
  ErrorCode ignored;
  socket_.shutdown(Socket::shutdown_send, ignored);
}

void WebStream::close() {
  is_open_ = false;
  source_.disconnect();
  ErrorCode ignored;
  socket_.close(ignored);
}

}  // namespace runstone
