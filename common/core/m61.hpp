// Arithmetic modulo the Mersenne prime 2^61 - 1, the field of the digests. A product of two
// residues is reduced with shifts and adds, and sums may be taken in any order.
#pragma once
#include <cstdint>

namespace runstone::m61 {

inline constexpr std::uint64_t kPrime = (1ULL << 61) - 1;

/// A product of two residues, or a sum of up to 63 of them.
__extension__ using Wide = unsigned __int128;

/// Returns the residue of any 64-bit value, in [0, kPrime).
constexpr std::uint64_t reduce(std::uint64_t v) {
  v = (v & kPrime) + (v >> 61);
  return v >= kPrime ? v - kPrime : v;
}
/// Return the sum, the difference and the product. They require both arguments below kPrime, and
/// the result is below kPrime too.
constexpr std::uint64_t add(std::uint64_t a, std::uint64_t b) {
  const std::uint64_t s = a + b;
  return s >= kPrime ? s - kPrime : s;
}
constexpr std::uint64_t sub(std::uint64_t a, std::uint64_t b) {
  return a >= b ? a - b : a + kPrime - b;
}
constexpr std::uint64_t mul(std::uint64_t a, std::uint64_t b) {
  const Wide p = static_cast<Wide>(a) * b;
  return add(static_cast<std::uint64_t>(p) & kPrime, static_cast<std::uint64_t>(p >> 61));
}

/// Returns the residue of any 128-bit value.
constexpr std::uint64_t reduce_wide(Wide v) {
  const Wide once = (v & kPrime) + (v >> 61);  // < 2^68
  const auto low = static_cast<std::uint64_t>(once) & kPrime;
  return add(reduce(low), reduce(static_cast<std::uint64_t>(once >> 61)));
}

}  // namespace runstone::m61
