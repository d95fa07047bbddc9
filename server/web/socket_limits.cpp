#include "server/web/socket_limits.hpp"

#include "common/core/assert.hpp"

namespace runstone {
namespace {

constexpr std::uint64_t kConnectsAtOnce = 10;  // times those of a second

}  // namespace

SocketLimits::SocketLimits(std::size_t per_address, std::uint64_t connections_per_second)
    : per_address_(per_address),
      connections_per_second_(connections_per_second),
      connects_({connections_per_second, connections_per_second * kConnectsAtOnce}) {}

const char* SocketLimits::try_add(AddressBlock from, TimeUs now_us) {
  if (!connects_.take(from, 1, now_us)) return "connections_per_second";
  const auto found = sockets_.find(from);
  if (found != sockets_.end() && found->second >= per_address_) return "sockets_per_address";
  ++sockets_[from];
  return nullptr;
}

void SocketLimits::remove(AddressBlock from) {
  const auto found = sockets_.find(from);
  RUNSTONE_ASSERT(found != sockets_.end());
  if (--found->second == 0) sockets_.erase(found);
}

}  // namespace runstone
