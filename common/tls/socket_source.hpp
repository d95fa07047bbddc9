// SocketSource: the bytes that have arrived at a TCP socket, as a TlsSource.
// Threads: one at a time.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <system_error>
#include <utility>

#include "common/core/bytes.hpp"
#include "common/tls/tls_channel.hpp"

namespace runstone {

class SocketSource final : public TlsSource {
 public:
  SocketSource() = default;
  /// Uses another socket, which must stay open while the source is used.
  explicit SocketSource(int socket) : socket_(socket) {}

  /// Uses the socket no more, because it is closed: its number may be another connection's soon.
  void disconnect() { socket_ = -1; }

  /// Never waits, whether the socket is blocking or not.
  std::size_t receive(std::span<std::uint8_t> into) override;
  /// Takes up to `bytes` bytes that have arrived. From now on receive() returns only these, without
  /// a system call, so that another thread may close the socket meanwhile.
  void hold(std::size_t bytes);
  /// Lets receive() use the socket again, behind the bytes that hold() took.
  void release() { is_held_ = false; }
  /// Lets receive() return at most so many bytes more. A peer could otherwise keep a reader busy
  /// with TLS records that hold no text.
  void allow(std::size_t bytes) { allowed_ = bytes; }
  /// Returns true if receive() returned 0 because of allow().
  bool is_used_up() const { return allowed_ == 0; }
  /// Returns how many bytes receive() has returned since the last call of this function.
  std::size_t take_count() { return std::exchange(count_, 0); }
  /// True at the end of the stream.
  bool is_at_end() const { return is_at_end_; }
  /// The error of the socket, if there was one.
  const std::error_code& error() const { return error_; }

 private:
  std::size_t receive_from_socket(std::span<std::uint8_t> into);

  int socket_ = -1;
  Bytes held_;
  bool is_held_ = false;
  std::size_t allowed_ = SIZE_MAX;
  std::size_t count_ = 0;
  bool is_at_end_ = false;
  std::error_code error_;
};

}  // namespace runstone
