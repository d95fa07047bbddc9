// Divider: division of flattened indices by a chunk side, without the divide instruction. Source:
// multiplication by the rounded-up reciprocal (Granlund and Montgomery 1994). It is exact here,
// because index * (divisor - 1) < 2^32: an index is below 2^22 and a divisor below 2^8.
#pragma once
#include <cstdint>

namespace runstone::rdm {

class Divider {
 public:
  /// Requires 0 < divisor < 256.
  explicit constexpr Divider(std::uint32_t divisor)
      : reciprocal_(((1ULL << 32) + divisor - 1) / divisor) {}
  /// Returns the quotient, rounded down. Requires index < 2^22.
  constexpr std::uint32_t operator()(std::uint32_t index) const {
    return static_cast<std::uint32_t>((index * reciprocal_) >> 32);
  }

 private:
  std::uint64_t reciprocal_;
};

}  // namespace runstone::rdm
