// LabLink: what stands between server and clients in an experiment, and where each of them runs.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "tests/bench/network/shaper.hpp"
#include "tests/bench/network/tun_link.hpp"
#include "tests/support/link_profile.hpp"

namespace runstone::bench {

/// loopback: nothing. namespaces: real packets between two network namespaces. shaper: a proxy on loopback.
enum class LinkKind : std::uint8_t { loopback, namespaces, shaper };
const char* name_of(LinkKind kind);

/// Empty if this process may make namespaces and TUN devices, else why not.
std::string why_no_namespaces();

class LabLink {
 public:
  /// A profile that passes everything has no link but loopback; any other one is of `kind`, which is not loopback.
  static Result<std::unique_ptr<LabLink>, std::string> make(const test::LinkProfile& profile,
                                                            LinkKind kind, std::uint64_t seed);

  LinkKind kind() const { return kind_; }
  Place& server_side() { return tun_ ? tun_->server_side() : *here_; }
  Place& client_side() { return tun_ ? tun_->client_side() : *here_; }
  /// Where a server has to listen.
  std::string server_address() const { return tun_ ? TunLink::kServerAddress : "127.0.0.1"; }
  /// The port of server_address() by which clients reach, through the link, what listens on `server_port` there.
  Result<std::uint16_t, std::string> entrance(std::uint16_t server_port);
  /// Ends the link; of namespaces, what passed.
  std::optional<TunCounts> stop();

 private:
  LabLink(LinkKind kind, const test::LinkProfile& profile, std::uint64_t seed)
      : kind_(kind), profile_(profile), seed_(seed) {}
  const LinkKind kind_;
  const test::LinkProfile profile_;
  std::uint64_t seed_;
  std::unique_ptr<Place> here_;
  std::unique_ptr<TunLink> tun_;
  std::vector<std::unique_ptr<Shaper>> shapers_;
};

}  // namespace runstone::bench
