// WaitingRequests: how many requests of an address, and of its range of addresses, wait for the
// maps.
// Thread: one.
#pragma once
#include <cstddef>
#include <map>

#include "common/core/address_block.hpp"

namespace runstone {

class WaitingRequests {
 public:
  static constexpr std::size_t kOfAddressMax = 16, kOfRangeMax = 64;

  /// Counts a request that begins to wait. Returns false, and counts nothing, if as many as allowed
  /// wait already. Cost: O(log addresses).
  bool add(AddressBlock from);
  /// Reports that a request that was counted has its answer.
  void remove(AddressBlock from);

 private:
  std::map<AddressBlock, std::size_t> address_counts_, range_counts_;  // no count is 0
};

}  // namespace runstone
