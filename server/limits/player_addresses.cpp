#include "server/limits/player_addresses.hpp"

#include <algorithm>
#include <set>

namespace runstone {
namespace {

bool is_ipv4(AddressBlock address) { return static_cast<std::uint64_t>(address) >> 32 == 0xffff; }

}  // namespace

bool is_of_host(AddressBlock address) {
  const auto v4 = static_cast<std::uint32_t>(static_cast<std::uint64_t>(address));
  return address == AddressBlock{} || (is_ipv4(address) && v4 >> 24 == 127);
}

void PlayerAddresses::note(const PublicKey& key, AddressBlock address,
                           const HasAuthor& has_author) {
  if (is_of_host(address)) return;
  Users& users = addresses_[address];
  if (users.used != 0) by_use_.erase(users.used);
  users.used = ++notes_;
  by_use_[users.used] = address;
  std::erase(users.keys, key);
  if (users.keys.size() == kKeysOfAddressMax) {
    const auto first = std::ranges::find_if_not(users.keys, has_author);
    users.keys.erase(first == users.keys.end() ? users.keys.begin() : first);
  }
  users.keys.push_back(key);
  if (const auto range = of_range(address); range.size() > kAddressesOfRangeMax)
    give_up_one(range, has_author);
  if (addresses_.size() > kAddressesMax) give_up_one(oldest(), has_author);
}

void PlayerAddresses::give_up_one(const std::vector<AddressBlock>& in_order,
                                  const HasAuthor& has_author) {
  const auto has_nobody = [&](AddressBlock address) {
    return std::ranges::none_of(addresses_.at(address).keys, has_author);
  };
  const auto found = std::ranges::find_if(in_order, has_nobody);
  const auto given_up = addresses_.find(found == in_order.end() ? in_order.front() : *found);
  by_use_.erase(given_up->second.used);
  addresses_.erase(given_up);
}

std::vector<AddressBlock> PlayerAddresses::of_range(AddressBlock address) const {
  if (is_ipv4(address)) return {};
  const AddressBlock first = address_range_of(address);
  std::vector<AddressBlock> range;
  for (auto at = addresses_.lower_bound(first);
       at != addresses_.end() && address_range_of(at->first) == first; ++at) {
    range.push_back(at->first);
  }
  std::ranges::sort(range, {}, [&](AddressBlock each) { return addresses_.at(each).used; });
  return range;
}

std::vector<AddressBlock> PlayerAddresses::oldest() const {
  std::vector<AddressBlock> found;
  for (const auto& [used, address] : by_use_) {
    if (found.size() == kAddressesOfRangeMax) break;
    found.push_back(address);
  }
  return found;
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
