// ListeningSocket: a socket on loopback that clients connect to.
#pragma once
#include <cstdint>
#include <optional>

namespace runstone::conformance {

class ListeningSocket {
 public:
  /// Takes a free port. Throws std::system_error if there is none.
  ListeningSocket();
  ~ListeningSocket();
  ListeningSocket(const ListeningSocket&) = delete;
  ListeningSocket& operator=(const ListeningSocket&) = delete;

  std::uint16_t port() const { return port_; }
  int descriptor() const { return socket_; }
  /// Accepts a connection that waits. Returns nullopt if there is none. The caller closes it.
  std::optional<int> accept();

 private:
  int socket_;
  std::uint16_t port_ = 0;
};

}  // namespace runstone::conformance
