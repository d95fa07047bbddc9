// TunLink: two network namespaces joined by a simulated link. A packet that leaves one namespace
// through its TUN device passes a LinkModel and enters the other when it is due. Every TCP
// connection has an access link of its own in both directions, like clients in different homes:
// connections share no queue. Real packets are lost and dropped, and real TCP reacts. The link has
// no name, and nothing of it outlives the process (Place). Requires CAP_NET_ADMIN and /dev/net/tun.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "bench/network/place.hpp"
#include "common/core/result.hpp"
#include "tests/support/net/link_model.hpp"

namespace runstone::bench {

struct TunCounts {
  test::LinkCounts to_client, to_server;
  std::uint64_t refused = 0;  // packets that the kernel did not accept
  double late_us_p99 = 0;     // delay of forwarding after packets were due
  double late_us_max = 0;
  double busy = 0;         // share of a core that the forwarder used
  bool real_time = false;  // the forwarder had a priority above all ordinary threads
};

class TunLink {
 public:
  static constexpr const char* kServerAddress = "10.77.0.1";
  static constexpr const char* kClientAddress = "10.77.0.2";
  static constexpr int kMtu = 1500;  // bytes, as usual on the internet

  /// Fails with the reason.
  static Result<std::unique_ptr<TunLink>, std::string> make(const test::LinkProfile& profile,
                                                            std::uint64_t seed);
  ~TunLink();
  TunLink(const TunLink&) = delete;
  TunLink& operator=(const TunLink&) = delete;

  Place& server_side();
  Place& client_side();
  /// Ends the forwarding and returns the counts. Later calls return the same counts.
  TunCounts stop();

 private:
  struct Forwarder;
  explicit TunLink(std::unique_ptr<Forwarder> forwarder);
  std::unique_ptr<Forwarder> forwarder_;
};

}  // namespace runstone::bench
