#include "server/web/waiting_requests.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

/// Adds requests until one is refused, and returns how many were counted.
std::size_t fill(WaitingRequests& waiting, AddressBlock from) {
  std::size_t out = 0;
  while (out < 1'000 && waiting.add(from)) ++out;
  return out;
}

}  // namespace

TEST_CASE("an address and a range have so many requests that wait, and no more", "[web]") {
  WaitingRequests waiting;
  const auto address = [](std::uint32_t last) { return address_block_v4(0xc0000200 + last); };
  CHECK(fill(waiting, address(1)) == WaitingRequests::kOfAddressMax);
  waiting.remove(address(1));
  CHECK(fill(waiting, address(1)) == 1);
  // The others of the range have what is left of its limit.
  std::size_t others = 0;
  for (std::uint32_t last = 2; last < 10; ++last) others += fill(waiting, address(last));
  CHECK(others == WaitingRequests::kOfRangeMax - WaitingRequests::kOfAddressMax);
  CHECK(fill(waiting, address_block_v4(0xc6336401)) == WaitingRequests::kOfAddressMax);
  waiting.remove(address(1));
  CHECK(waiting.add(address(9)));
}
