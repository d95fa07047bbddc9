// SocketLimits: how many connections an address may have, and how often it may connect.
// Thread: one. Times are arguments (microseconds of one steady clock).
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>

#include "server/limits/address_ledger.hpp"

namespace runstone {

class SocketLimits {
 public:
  /// `connections_per_second`: of an address, ten times as many at once; 0: no limit.
  SocketLimits(std::size_t per_address, std::uint64_t connections_per_second);

  /// Counts a connection. Returns false if the address may not have it now.
  bool add(AddressBlock from, TimeUs now_us);
  /// Reports that a connection that was counted has ended.
  void remove(AddressBlock from);
  /// Returns the number of addresses that have connections.
  std::size_t addresses() const { return sockets_.size(); }

 private:
  const std::size_t per_address_;
  AddressLedger connects_;
  std::map<AddressBlock, std::size_t> sockets_;  // no count is 0
};

}  // namespace runstone
