// Helpers for plain sockets of tests on loopback.
#pragma once
#include <netinet/in.h>
#include <poll.h>

#include <cstdint>

namespace runstone::test {

/// `address` and `port` are in the byte order of the machine.
inline sockaddr_in ipv4_endpoint(std::uint32_t address, std::uint16_t port) {
  sockaddr_in out{};
  out.sin_family = AF_INET;
  out.sin_port = htons(port);
  out.sin_addr.s_addr = htonl(address);
  return out;
}

/// Returns true if the socket can be read within the time, or has failed.
inline bool wait_input(int socket, int deadline_ms) {
  pollfd wait{socket, POLLIN, 0};
  return ::poll(&wait, 1, deadline_ms) > 0;
}

}  // namespace runstone::test
