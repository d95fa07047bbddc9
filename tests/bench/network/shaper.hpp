// Shaper: a link without privileges: a TCP proxy on loopback that lets bytes pass through a LinkModel both ways, each
// connection through a link of its own. Bytes count in segments of an Ethernet packet, headers included.
// What differs from a real link: a lost segment comes a round trip later, and all behind it wait for it, but nobody
// slows down for it (no congestion control sees the loss); nothing is dropped for want of room, the proxy stops
// reading instead; and the kernel's buffers before and behind it hold up to some tens of KB more.
// One thread of its own.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "common/core/result.hpp"
#include "tests/support/link_model.hpp"

namespace runstone::bench {

class Shaper {
 public:
  /// Passes everything that comes to a free port of loopback on to `server_port` there. The error says what failed.
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
