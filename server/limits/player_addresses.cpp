#include "server/limits/player_addresses.hpp"

#include <algorithm>
#include <set>

namespace runstone {

void PlayerAddresses::note(const PublicKey& key, AddressBlock address) {
  if (address == AddressBlock{}) return;
  Users& users = addresses_[address];
  if (users.used != 0) by_use_.erase(users.used);
  users.used = ++notes_;
  by_use_[users.used] = address;
  std::erase(users.keys, key);
  if (users.keys.size() == kKeysOfAddressMax) users.keys.erase(users.keys.begin());
  users.keys.push_back(key);
  if (addresses_.size() <= kAddressesMax) return;
  const auto oldest = by_use_.begin();
  addresses_.erase(oldest->second);
  by_use_.erase(oldest);
}

std::vector<PublicKey> PlayerAddresses::sharing(const PublicKey& key) const {
  std::set<PublicKey> found;
  for (const auto& [address, users] : addresses_) {
    if (std::ranges::find(users.keys, key) != users.keys.end())
      found.insert(users.keys.begin(), users.keys.end());
  }
  return {found.begin(), found.end()};
}

}  // namespace runstone
