// FanOutSender: sends equal bytes to many receivers. There are two senders. The floor is a loop that
// only calls OpenSSL or the kernel. The other sender uses the server's sessions.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "common/core/result.hpp"

namespace runstone::bench {

class FanOutSender {
 public:
  virtual ~FanOutSender() = default;
  /// Sends a frame header and `body_bytes` bytes to every receiver. Returns when each connection has
  /// been written. The result is the processor time of the sending thread in nanoseconds. On
  /// loopback it includes the kernel's delivery to the receivers.
  virtual std::int64_t send_to_all(std::size_t body_bytes) = 0;
};

struct FanOutSize {
  std::size_t receivers = 0;
  bool is_encrypted = false;
};

/// Makes a sender and its receivers.
Result<std::unique_ptr<FanOutSender>, std::string> make_floor_sender(const FanOutSize& size);
Result<std::unique_ptr<FanOutSender>, std::string> make_session_sender(const FanOutSize& size);

}  // namespace runstone::bench
