// The TLS handshake of the blocking sockets of tests.
#pragma once
#include <sys/socket.h>

#include <optional>
#include <string>
#include <utility>

#include "common/tls/socket_source.hpp"
#include "common/tls/tls_channel.hpp"
#include "tests/support/tls/ipv4_socket.hpp"

namespace runstone::test {

/// Sends all bytes. Returns false if the connection has failed.
inline bool send_all(int socket, ByteView bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
  return true;
}

/// Performs the handshake of a client with the server `host` over a connected socket. Returns
/// nullopt if it fails, or if the server is silent for ten seconds. `source` must outlive the
/// channel.
inline std::optional<TlsChannel> connect_tls(int socket, SocketSource& source,
                                             const TlsContext& context, const std::string& host) {
  constexpr int kSilentMsMax = 10'000;
  source = SocketSource(socket);
  TlsChannel channel = TlsChannel::connect(context, source, host);
  for (;;) {
    const TlsChannel::Status status = channel.handshake();
    if (!send_all(socket, std::exchange(channel.output(), {}))) return std::nullopt;
    if (status == TlsChannel::Status::done) return channel;
    const bool is_over = source.is_at_end() || source.error();
    if (status != TlsChannel::Status::wants_input || is_over) return std::nullopt;
    if (!wait_input(socket, kSilentMsMax)) return std::nullopt;
  }
}

}  // namespace runstone::test
