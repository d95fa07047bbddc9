// AddressRange: network addresses with a common prefix.
#pragma once
#include <compare>
#include <cstdint>

#include "common/core/address_block.hpp"

namespace runstone {

struct AddressRange {
  AddressBlock first{};  // the other blocks of the range differ in the bits behind the prefix only
  std::uint8_t bits = 64;  // of the prefix of the block, 0 .. 64; an IPv4 prefix /n has 32 + n

  constexpr bool contains(AddressBlock block) const {
    const auto differing = static_cast<std::uint64_t>(first) ^ static_cast<std::uint64_t>(block);
    return bits == 0 || differing >> (64 - bits) == 0;
  }
  /// Returns true if every bit behind the prefix is 0, so that equal ranges have equal values.
  constexpr bool is_canonical() const {
    return bits <= 64 && (bits == 64 || static_cast<std::uint64_t>(first) << bits == 0);
  }
  friend constexpr auto operator<=>(const AddressRange&, const AddressRange&) = default;
};

}  // namespace runstone
