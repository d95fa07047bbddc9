#include "bench/network/testbed_link.hpp"

#include <utility>

#include "common/core/assert.hpp"

namespace runstone::bench {

const char* name_of(LinkKind kind) {
  switch (kind) {
    case LinkKind::loopback:
      return "loopback";
    case LinkKind::namespaces:
      return "namespaces";
    case LinkKind::shaper:
      return "shaper";
  }
  return "";
}

std::string why_no_namespaces() {
  const auto link = TunLink::make(test::link_profiles().front(), 0);
  return link ? "" : link.error();
}

Result<std::unique_ptr<TestbedLink>, std::string> TestbedLink::make(
    const test::LinkProfile& profile, LinkKind kind, std::uint64_t seed) {
  if (profile.passes_all()) kind = LinkKind::loopback;
  RUNSTONE_ASSERT(profile.passes_all() || kind != LinkKind::loopback);
  std::unique_ptr<TestbedLink> link(new TestbedLink(kind, profile, seed));
  if (kind == LinkKind::namespaces) {
    auto tun = TunLink::make(profile, seed);
    if (!tun) return failure(tun.error());
    link->tun_ = *std::move(tun);
  } else {
    link->here_ = Place::here();
  }
  return link;
}

Result<std::uint16_t, std::string> TestbedLink::entrance(std::uint16_t server_port) {
  if (kind_ != LinkKind::shaper) return server_port;
  auto shaper = Shaper::start(profile_, seed_++, server_port);
  if (!shaper) return failure(shaper.error());
  shapers_.push_back(*std::move(shaper));
  return shapers_.back()->port();
}

std::optional<TunCounts> TestbedLink::stop() {
  shapers_.clear();
  if (!tun_) return std::nullopt;
  return tun_->stop();
}

}  // namespace runstone::bench
