// FakeServer: a Unix socket in the place of the server's, with which a test decides what the
// gateway gets, and what is read of it. Reads and writes have a deadline.
#pragma once
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <string>

#include "protocol/codec/proxy_header.hpp"

namespace runstone::test {

class FakeServer {
 public:
  /// One connection more than this waits for accept() before others are refused.
  static constexpr int kQueueMax = 8;

  explicit FakeServer(const std::string& path) : listening_(::socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un here{};
    here.sun_family = AF_UNIX;
    std::strncpy(here.sun_path, path.c_str(), sizeof here.sun_path - 1);
    REQUIRE(::bind(listening_, reinterpret_cast<const sockaddr*>(&here), sizeof here) == 0);
    REQUIRE(::listen(listening_, kQueueMax) == 0);
  }
  ~FakeServer() {
    hang_up();
    ::close(listening_);
  }
  FakeServer(const FakeServer&) = delete;
  FakeServer& operator=(const FakeServer&) = delete;

  /// Waits for a connection of the gateway and returns the client that its header names.
  PeerEndpoint accept() {
    REQUIRE(waits(listening_, POLLIN, kDeadlineMs));
    socket_ = ::accept(listening_, nullptr, nullptr);
    const Bytes header = read(kProxyPrefixBytes + 12);  // of an IPv4 client, without TLVs
    const auto parsed = read_proxy_header(header);
    REQUIRE(parsed.has_value());
    REQUIRE(parsed->client.has_value());
    return *parsed->client;
  }
  /// Reads exactly so many bytes, or fewer at the end of the stream or the deadline.
  Bytes read(std::size_t bytes) {
    Bytes out(bytes);
    std::size_t have = 0;
    while (have < bytes && waits(socket_, POLLIN, kDeadlineMs)) {
      const ssize_t got = ::recv(socket_, out.data() + have, bytes - have, 0);
      if (got <= 0) break;
      have += static_cast<std::size_t>(got);
    }
    out.resize(have);
    return out;
  }
  /// Writes the bytes again and again until the gateway takes no more for a second, or `bytes_max`
  /// were written. Returns how many the gateway took.
  std::size_t write_until_full(ByteView bytes, std::size_t bytes_max) {
    std::size_t written = 0;
    while (written < bytes_max && waits(socket_, POLLOUT, 1'000)) {
      const std::size_t at = written % bytes.size();
      const ssize_t sent =
          ::send(socket_, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL | MSG_DONTWAIT);
      if (sent <= 0) break;
      written += static_cast<std::size_t>(sent);
    }
    return written;
  }
  void write(ByteView bytes) { write_until_full(bytes, bytes.size()); }
  /// Reads and drops what has come. Returns true if the gateway has closed the connection.
  bool drops_until_closed() {
    Bytes dropped(65'536);
    while (waits(socket_, POLLIN, 0)) {
      if (::recv(socket_, dropped.data(), dropped.size(), 0) <= 0) return true;
    }
    return false;
  }
  void hang_up() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
  }

 private:
  static constexpr int kDeadlineMs = 10'000;

  static bool waits(int socket, short event, int deadline_ms) {
    pollfd wait{socket, event, 0};
    return ::poll(&wait, 1, deadline_ms) > 0;
  }

  int listening_, socket_ = -1;
};

}  // namespace runstone::test
