// PlayerAddresses: which players came from which network address since the start, so that a
// moderator finds the other keys of one person. It is kept in memory alone: nothing is written,
// sent or logged, and a restart forgets all of it.
// Memory: bounded by the limits below. If a limit is passed, players without an author number are
// given up first, and then what was noted longest ago. So nobody displaces players who have built
// with new keys that build nothing, nor with the many addresses of one IPv6 /48.
// Thread: one.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "common/core/address_block.hpp"
#include "common/core/public_key.hpp"

namespace runstone {

/// Returns true for sessions that have no address of their own: it is not known, or it is the
/// loopback of the host (127.0.0.0/8, ::1), from where a proxy brings players of everywhere.
bool is_of_host(AddressBlock address);

class PlayerAddresses {
 public:
  static constexpr std::size_t kAddressesMax = 4'096;
  static constexpr std::size_t kAddressesOfRangeMax = 64;  // of one IPv6 /48
  static constexpr std::size_t kKeysOfAddressMax = 64;

  /// Returns true if a player has an author number, which is so if the player has built or is here.
  /// Must not be empty.
  using HasAuthor = std::function<bool(const PublicKey&)>;

  /// Notes that a player has joined from an address, unless is_of_host() holds for it. Cost: O(log
  /// addresses + keys of the address); if a limit is passed, also up to kAddressesOfRangeMax *
  /// kKeysOfAddressMax calls of `has_author`.
  void note(const PublicKey& key, AddressBlock address, const HasAuthor& has_author);
  /// Returns the players who came from any address from which this one came, the player included,
  /// ascending; empty if the player did not come. Cost: O(all keys that are kept).
  std::vector<PublicKey> sharing(const PublicKey& key) const;
  std::size_t size() const { return addresses_.size(); }

 private:
  struct Users {
    std::vector<PublicKey> keys;  // the newest last
    std::uint64_t used = 0;       // number of the newest note()
  };
  /// Gives up one of these addresses, which are in the order of their use: the first one from which
  /// nobody with an author number came, otherwise the first one. Requires at least one.
  void give_up_one(const std::vector<AddressBlock>& in_order, const HasAuthor& has_author);
  /// Returns the addresses of the IPv6 /48 of an address, in the order of their use. Returns none
  /// for an IPv4 address.
  std::vector<AddressBlock> of_range(AddressBlock address) const;
  /// Returns the addresses that were used longest ago, in the order of their use.
  std::vector<AddressBlock> oldest() const;

  std::map<AddressBlock, Users> addresses_;
  std::map<std::uint64_t, AddressBlock> by_use_;
  std::uint64_t notes_ = 0;
};

}  // namespace runstone
