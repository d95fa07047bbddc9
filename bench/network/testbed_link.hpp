// TestbedLink: the link between server and clients in an experiment, and the places where they run.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/network/shaper.hpp"
#include "bench/network/tun_link.hpp"
#include "common/core/result.hpp"
#include "tests/support/net/link_profile.hpp"

namespace runstone::bench {

/// loopback: no link. namespaces: real packets between two network namespaces. shaper: a proxy on
/// loopback.
enum class LinkKind : std::uint8_t { loopback, namespaces, shaper };
const char* name_of(LinkKind kind);

/// Returns an empty text if this process may make namespaces and TUN devices, otherwise the reason.
std::string why_no_namespaces();

class TestbedLink {
 public:
  /// Makes a link. A profile that passes everything gives loopback. Any other profile gives a link
  /// of `kind`, which is not loopback.
  static Result<std::unique_ptr<TestbedLink>, std::string> make(const test::LinkProfile& profile,
                                                                LinkKind kind, std::uint64_t seed);

  LinkKind kind() const { return kind_; }
  Place& server_side() { return tun_ ? tun_->server_side() : *here_; }
  Place& client_side() { return tun_ ? tun_->client_side() : *here_; }
  /// Returns the address on which a server must listen.
  std::string server_address() const { return tun_ ? TunLink::kServerAddress : "127.0.0.1"; }
  /// Returns the port of server_address() by which clients reach `server_port` through the link.
  Result<std::uint16_t, std::string> entrance(std::uint16_t server_port);
  /// Ends the link. Returns the counts of its packets if it joins namespaces.
  std::optional<TunCounts> stop();

 private:
  TestbedLink(LinkKind kind, const test::LinkProfile& profile, std::uint64_t seed)
      : kind_(kind), profile_(profile), seed_(seed) {}
  const LinkKind kind_;
  const test::LinkProfile profile_;
  std::uint64_t seed_;
  std::unique_ptr<Place> here_;
  std::unique_ptr<TunLink> tun_;
  std::vector<std::unique_ptr<Shaper>> shapers_;
};

}  // namespace runstone::bench
