#include "tests/conformance/net/listening_socket.hpp"

#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace runstone::conformance {

ListeningSocket::ListeningSocket()
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  sockaddr_in here{};
  here.sin_family = AF_INET;
  here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof here;
  auto* address = reinterpret_cast<sockaddr*>(&here);
  if (::bind(socket_, address, size) != 0 || ::listen(socket_, 16) != 0 ||
      ::getsockname(socket_, address, &size) != 0) {
    const int wrong = errno;
    ::close(socket_);
    throw std::system_error(wrong, std::generic_category(), "cannot listen on 127.0.0.1");
  }
  port_ = ntohs(here.sin_port);
}

ListeningSocket::~ListeningSocket() { ::close(socket_); }

std::optional<int> ListeningSocket::accept() {
  const int got = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
  return got < 0 ? std::nullopt : std::optional(got);
}

}  // namespace runstone::conformance
