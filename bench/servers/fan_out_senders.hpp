// FanOutSender: sends the same bytes to many receivers. One sender does nothing but that, with OpenSSL
// and the kernel: the floor. The other one sends commits as the server does.
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
  /// Sends `body_bytes` bytes, with the header of a frame before them, to every receiver. Returns when
  /// the kernel has all of it. The result is the processor time that this took, in nanoseconds.
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
