// Shaper: a link without privileges: a TCP proxy on loopback. Bytes pass through a LinkModel in
// both directions, and each connection has a link of its own. Bytes count in segments of an
// Ethernet packet, headers included. It differs from a real link in three ways:
// - A lost segment arrives one round trip later, and all behind it wait for it, but nobody slows
//   down: no congestion control sees the loss.
// - Nothing is dropped for lack of room; the proxy stops reading instead.
// - The kernel's buffers before and behind it hold up to some tens of KB more.
// It has one thread of its own.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "common/core/result.hpp"
#include "tests/support/net/link_model.hpp"

namespace runstone::bench {

class Shaper {
 public:
  /// Forwards connections from a free port of loopback to `server_port` there. Fails with the
  /// reason.
  static Result<std::unique_ptr<Shaper>, std::string> start(const test::LinkProfile& profile,
                                                            std::uint64_t seed,
                                                            std::uint16_t server_port);
  /// Cuts all connections.
  ~Shaper();
  Shaper(const Shaper&) = delete;
  Shaper& operator=(const Shaper&) = delete;

  std::uint16_t port() const;

 private:
  struct Parts;
  explicit Shaper(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace runstone::bench
