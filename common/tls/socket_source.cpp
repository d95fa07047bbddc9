#include "common/tls/socket_source.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <cerrno>

namespace runstone {

std::size_t SocketSource::receive(std::span<std::uint8_t> into) {
  const std::size_t wanted = std::min(into.size(), allowed_);
  std::size_t got = 0;
  if (!held_.empty()) {
    got = std::min(wanted, held_.size());
    std::copy_n(held_.begin(), got, into.begin());
    held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(got));
    if (held_.empty()) held_ = {};  // an idle connection keeps no memory
  } else if (!is_held_) {
    got = receive_from_socket(into.first(wanted));
  }
  count_ += got;
  if (allowed_ != SIZE_MAX) allowed_ -= got;
  return got;
}

void SocketSource::hold(std::size_t bytes) {
  const std::size_t before = held_.size();
  held_.resize(before + bytes);
  held_.resize(before + receive_from_socket(std::span(held_).subspan(before)));
  is_held_ = true;
}

std::size_t SocketSource::receive_from_socket(std::span<std::uint8_t> into) {
  if (socket_ < 0) is_at_end_ = true;
  if (into.empty() || is_at_end_) return 0;
  const ssize_t got = ::recv(socket_, into.data(), into.size(), MSG_DONTWAIT);
  if (got > 0) return static_cast<std::size_t>(got);
  if (got == 0) {
    is_at_end_ = true;
  } else if (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) {
    error_ = {errno, std::system_category()};
  }
  return 0;
}

}  // namespace runstone
