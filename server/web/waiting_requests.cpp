#include "server/web/waiting_requests.hpp"

#include "common/core/assert.hpp"

namespace runstone {
namespace {

using Counts = std::map<AddressBlock, std::size_t>;

std::size_t count_of(const Counts& counts, AddressBlock of) {
  const auto found = counts.find(of);
  return found == counts.end() ? 0 : found->second;
}

void take_one(Counts& counts, AddressBlock of) {
  const auto found = counts.find(of);
  RUNSTONE_ASSERT(found != counts.end());
  if (--found->second == 0) counts.erase(found);
}

}  // namespace

bool WaitingRequests::add(AddressBlock from) {
  const AddressBlock range = address_range_of(from);
  if (count_of(address_counts_, from) >= kOfAddressMax ||
      count_of(range_counts_, range) >= kOfRangeMax)
    return false;
  ++address_counts_[from];
  ++range_counts_[range];
  return true;
}

void WaitingRequests::remove(AddressBlock from) {
  take_one(address_counts_, from);
  take_one(range_counts_, address_range_of(from));
}

}  // namespace runstone
