// ConnectionLedger: how often each address may connect. A TLS handshake costs the server a
// signature, so an address that connects too often is refused before it. A budget that has refilled
// is forgotten, which bounds the memory by the addresses that connected lately.
// Thread: one. Times are arguments (microseconds of one steady clock).
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>

#include "common/core/address_block.hpp"
#include "common/core/token_bucket.hpp"

namespace runstone {

class ConnectionLedger {
 public:
  /// Connections a second of each address, and ten times as many at once; 0: no limit.
  explicit ConnectionLedger(std::uint64_t per_second) : per_second_(per_second) {}

  /// Counts a connection. Returns false if the address has made too many. Cost: O(log addresses).
  bool take(AddressBlock from, TimeUs now_us);

  /// Returns the number of addresses that are kept.
  std::size_t size() const { return buckets_.size(); }

 private:
  void forget_full(TimeUs now_us);

  const std::uint64_t per_second_;
  std::map<AddressBlock, TokenBucket> buckets_;
  std::size_t size_kept_ = 0;  // after the last forget_full()
};

}  // namespace runstone
