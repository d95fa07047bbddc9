// EchoProbe: the round trip of a message that a plain Asio server sends back, as a lower bound
// beside a measurement. It sends at a fixed rate that does not depend on answers, on a connection
// of its own through the link. So the load of the machine and the link affect both measurements. An
// edit from one client over the server to another takes at least one such round trip.
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "bench/network/testbed_link.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

class EchoProbe {
 public:
  static constexpr std::size_t kMessageBytes = 128;

  /// Starts to send `rate` messages a second. Fails with the reason.
  static Result<std::unique_ptr<EchoProbe>, std::string> start(TestbedLink& link, double rate);
  ~EchoProbe();
  EchoProbe(const EchoProbe&) = delete;
  EchoProbe& operator=(const EchoProbe&) = delete;

  /// Stops sending and waits a second for the answers. Returns the times from when each message was
  /// due to when it was back, in ms; infinite if it did not come back.
  std::vector<double> stop();

 private:
  struct Parts;
  explicit EchoProbe(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace runstone::bench
