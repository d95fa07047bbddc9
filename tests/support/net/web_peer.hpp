// WebPeer: a blocking socket of a browser's side, over TLS if told so: HTTP requests, and a
// WebSocket (RFC 6455) written by hand, so that it can send what no library sends. Reads have a
// deadline, so a test fails instead of hanging.
#pragma once
#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "common/core/bytes.hpp"
#include "common/tls/socket_source.hpp"
#include "common/tls/tls_channel.hpp"
#include "tests/support/tls/ipv4_socket.hpp"
#include "tests/support/tls/tls_client.hpp"

namespace runstone::test {

struct HttpReply {
  int status = 0;  // 0: none came
  std::string head, body;
  /// Returns the value of a header, or "" if there is none. `name` is in the spelling of the reply.
  std::string header(const std::string& name) const {
    const std::size_t at = head.find("\r\n" + name + ": ");
    if (at == std::string::npos) return "";
    const std::size_t begin = at + name.size() + 4;
    return head.substr(begin, head.find("\r\n", begin) - begin);
  }
};

/// A message, or the close frame, of a WebSocket.
struct WebMessage {
  enum Kind { text = 1, binary = 2, close = 8, ping = 9, pong = 10 };
  int kind = 0;
  Bytes bytes;
  int close_code() const { return bytes.size() < 2 ? 0 : bytes[0] << 8 | bytes[1]; }
  std::string close_words() const { return {bytes.begin() + 2, bytes.end()}; }
};

class WebPeer {
 public:
  /// Connects to a gateway on this machine from the IPv4 address `from` (host order).
  explicit WebPeer(std::uint16_t port, std::uint32_t from = INADDR_LOOPBACK,
                   bool is_encrypted = false, const TlsContext& context = TlsContext::client(),
                   const std::string& tls_host = "127.0.0.1")
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)), port_(port) {
    const sockaddr_in here = ipv4_endpoint(from, 0), there = ipv4_endpoint(INADDR_LOOPBACK, port);
    is_open_ = ::bind(socket_, reinterpret_cast<const sockaddr*>(&here), sizeof here) == 0 &&
               ::connect(socket_, reinterpret_cast<const sockaddr*>(&there), sizeof there) == 0;
    if (!is_open_ || !is_encrypted) return;
    auto channel = connect_tls(socket_, source_, context, tls_host);
    is_open_ = channel.has_value();
    if (channel) tls_.emplace(*std::move(channel));
  }
  ~WebPeer() { ::close(socket_); }
  WebPeer(const WebPeer&) = delete;
  WebPeer& operator=(const WebPeer&) = delete;

  bool is_open() const { return is_open_; }
  int native_handle() const { return socket_; }

  void send(const std::string& text) { send(Bytes(text.begin(), text.end())); }
  void send(Bytes bytes) {
    if (!is_open_) return;
    if (tls_) {
      if (!tls_->write(bytes)) return;
      bytes = std::exchange(tls_->output(), {});
    }
    if (!send_all(socket_, bytes)) is_open_ = false;
  }

  /// Sends a request and returns the reply. `more`: further header lines, each with its line end.
  HttpReply request(const std::string& method, const std::string& target,
                    const std::string& more = "") {
    send(method + " " + target + " HTTP/1.1\r\nHost: " + host() + "\r\n" + more + "\r\n");
    return reply(method == "HEAD");
  }
  HttpReply get(const std::string& target) { return request("GET", target); }
  HttpReply reply(bool has_no_body = false) {
    HttpReply out;
    while (in_.find("\r\n\r\n") == std::string::npos) {
      if (!read_more()) return out;
    }
    const std::size_t end = in_.find("\r\n\r\n") + 4;
    out.head = in_.substr(0, end);
    in_.erase(0, end);
    out.status = std::stoi(out.head.substr(9, 3));
    const std::string length = out.header("Content-Length");
    const std::size_t bytes = length.empty() || has_no_body ? 0 : std::stoul(length);
    while (in_.size() < bytes) {
      if (!read_more()) break;
    }
    out.body = in_.substr(0, bytes);
    in_.erase(0, bytes);
    return out;
  }
  std::string host() const { return "127.0.0.1:" + std::to_string(port_); }

  /// Asks for a WebSocket. The status is 101 if there is one.
  HttpReply upgrade(const std::string& target = "/play", const std::string& more = "") {
    return request("GET", target,
                   "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                   "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                       more);
  }
  /// Sends the header of a WebSocket frame, masked, and the bytes.
  void send_frame(int kind, ByteView bytes, bool is_last = true) {
    Bytes out{static_cast<std::uint8_t>(kind | (is_last ? 0x80 : 0))};
    append_length(out, bytes.size());
    constexpr std::array<std::uint8_t, 4> kMask{0x12, 0x34, 0x56, 0x78};
    out.insert(out.end(), kMask.begin(), kMask.end());
    for (std::size_t i = 0; i < bytes.size(); ++i) out.push_back(bytes[i] ^ kMask[i % 4]);
    send(std::move(out));
  }
  static void append_length(Bytes& out, std::uint64_t length) {
    const int size = length < 126 ? 0 : length < 65'536 ? 2 : 8;
    out.push_back(static_cast<std::uint8_t>(0x80 | (size == 0 ? length : size == 2 ? 126 : 127)));
    for (int i = size - 1; i >= 0; --i) out.push_back(static_cast<std::uint8_t>(length >> (8 * i)));
  }
  /// Returns the next message or close frame, or nullopt at the end of the stream or the deadline.
  /// Pings are answered.
  std::optional<WebMessage> next(int deadline_ms = 10'000) {
    for (;;) {
      while (!has_frame()) {
        if (!read_more(deadline_ms)) return std::nullopt;
      }
      WebMessage out = take_frame();
      if (out.kind == WebMessage::ping) {
        send_frame(WebMessage::pong, out.bytes);
      } else if (out.kind != WebMessage::pong) {
        return out;
      }
    }
  }
  /// Reads until the close frame, and answers it. Returns it, or nullopt if none came.
  std::optional<WebMessage> next_close() {
    while (auto message = next()) {
      if (message->kind != WebMessage::close) continue;
      send_frame(WebMessage::close, message->bytes);
      return message;
    }
    return std::nullopt;
  }
  /// Returns true if the gateway closes the connection within the time.
  bool sees_the_end(int deadline_ms = 10'000) {
    while (read_more(deadline_ms)) {
    }
    return !is_open_;
  }

 private:
  bool read_more(int deadline_ms = 10'000) {
    if (!is_open_) return false;
    Bytes buffer(65'536);
    for (;;) {
      if (tls_) {
        std::size_t bytes = 0;
        const TlsChannel::Status status = tls_->read(buffer, bytes);
        if (status == TlsChannel::Status::done) return add(buffer, bytes);
        if (status != TlsChannel::Status::wants_input || source_.is_at_end() || source_.error())
          return is_open_ = false;
      }
      if (!wait_input(socket_, deadline_ms)) return false;
      if (tls_) continue;
      const ssize_t got = ::recv(socket_, buffer.data(), buffer.size(), 0);
      if (got <= 0) return is_open_ = false;
      return add(buffer, static_cast<std::size_t>(got));
    }
  }
  bool add(const Bytes& buffer, std::size_t bytes) {
    in_.append(reinterpret_cast<const char*>(buffer.data()), bytes);
    return true;
  }
  std::size_t byte(std::size_t at) const { return static_cast<std::uint8_t>(in_[at]); }
  /// Returns the bytes of the header and the payload of the first frame, or nullopt if the header
  /// is not complete.
  std::optional<std::pair<std::size_t, std::size_t>> frame_sizes() const {
    if (in_.size() < 2) return std::nullopt;
    const std::size_t first = byte(1);
    const std::size_t more = first == 126 ? 2 : first == 127 ? 8 : 0;
    if (in_.size() < 2 + more) return std::nullopt;
    std::size_t length = more == 0 ? first : 0;
    for (std::size_t i = 0; i < more; ++i) length = length << 8 | byte(2 + i);
    return std::pair(2 + more, length);
  }
  bool has_frame() const {
    const auto sizes = frame_sizes();
    return sizes && in_.size() >= sizes->first + sizes->second;
  }
  WebMessage take_frame() {
    const auto [header, length] = *frame_sizes();
    const auto begin = in_.begin() + static_cast<std::ptrdiff_t>(header);
    WebMessage out{static_cast<int>(byte(0) & 0x0f),
                   Bytes(begin, begin + static_cast<std::ptrdiff_t>(length))};
    in_.erase(0, header + length);
    return out;
  }

  int socket_;
  std::uint16_t port_;
  bool is_open_ = false;
  SocketSource source_;
  std::optional<TlsChannel> tls_;
  std::string in_;  // read and not used yet
};

}  // namespace runstone::test
