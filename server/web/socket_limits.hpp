// SocketLimits: how many connections an address may have, and how often it may connect and ask.
// Thread: one. Times are arguments (microseconds of one steady clock).
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>

#include "server/limits/address_ledger.hpp"

namespace runstone {

class SocketLimits {
 public:
  /// `connections_per_second`: of an address, ten times as many at once; 0: no limit. A further
  /// request on a connection counts as one more connection.
  SocketLimits(std::size_t per_address, std::uint64_t connections_per_second);

  /// Counts a connection and returns null. If the address may not have it now, it counts nothing
  /// and returns the name of the setting that forbids it.
  const char* try_add(AddressBlock from, TimeUs now_us);
  /// Counts a connection. Returns false, and counts nothing, if the address may not have it now.
  bool add(AddressBlock from, TimeUs now_us) { return try_add(from, now_us) == nullptr; }
  /// Counts a further request on a connection. Returns false if the address may not ask now.
  bool ask(AddressBlock from, TimeUs now_us) { return connects_.take(from, 1, now_us); }
  /// Charges an address that broke a rule: it may connect about once in the next second.
  void broke_rule(AddressBlock from, TimeUs now_us) {
    connects_.charge(from, connections_per_second_, now_us);
  }
  /// Reports that a connection that was counted has ended.
  void remove(AddressBlock from);
  /// Returns the number of addresses that have connections.
  std::size_t addresses() const { return sockets_.size(); }

 private:
  const std::size_t per_address_;
  const std::uint64_t connections_per_second_;
  AddressLedger connects_;
  std::map<AddressBlock, std::size_t> sockets_;  // no count is 0
};

}  // namespace runstone
