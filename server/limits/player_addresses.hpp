// PlayerAddresses: which players came from which network address since the start, so that a
// moderator finds the other keys of one person. It is kept in memory alone: nothing is written, sent
// or logged, and a restart forgets all of it.
// Memory: bounded by kAddressesMax and kKeysOfAddressMax; the address that was used longest ago is
// given up first. Thread: one.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "common/core/address_block.hpp"
#include "common/core/public_key.hpp"

namespace runstone {

class PlayerAddresses {
 public:
  static constexpr std::size_t kAddressesMax = 4'096;
  static constexpr std::size_t kKeysOfAddressMax = 64;  // the newest ones

  /// Notes that a player has joined from an address. The block of zeros, that of the loopback of
  /// IPv6 and of sessions without an address, is left out. Cost: O(log addresses + keys of it).
  void note(const PublicKey& key, AddressBlock address);
  /// Returns the players who came from any address from which this one came, the player included,
  /// ascending; empty if the player did not come. Cost: O(all keys that are kept).
  std::vector<PublicKey> sharing(const PublicKey& key) const;
  std::size_t size() const { return addresses_.size(); }

 private:
  struct Users {
    std::vector<PublicKey> keys;  // the newest last
    std::uint64_t used = 0;       // number of the newest note()
  };
  std::map<AddressBlock, Users> addresses_;
  std::map<std::uint64_t, AddressBlock> by_use_;
  std::uint64_t notes_ = 0;
};

}  // namespace runstone
