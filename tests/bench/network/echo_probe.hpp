// EchoProbe: how long the bare minimum takes beside what is measured: a message that a plain Asio server sends back.
// Open loop, on a connection of its own through the link, so that the same busy machine and the same link are in
// both. A round trip of it is what an edit needs from one client over the server to another.
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "tests/bench/network/lab_link.hpp"

namespace runstone::bench {

class EchoProbe {
 public:
  static constexpr std::size_t kMessageBytes = 128;

  /// Sends `rate` messages a second from now on. The error says what failed.
  static Result<std::unique_ptr<EchoProbe>, std::string> start(LabLink& link, double rate);
  ~EchoProbe();
  EchoProbe(const EchoProbe&) = delete;
  EchoProbe& operator=(const EchoProbe&) = delete;

  /// Sends no more, waits a second for the rest, and returns in ms, from when each message was due to when it was back.
  /// What did not come back is infinite.
  std::vector<double> stop();

 private:
  struct Parts;
  explicit EchoProbe(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace runstone::bench
