// Fixed integer mixing. std::hash is never used, because results reach logs, worlds and digests.
#pragma once
#include <cstdint>

namespace runstone {

/// Finaliser of SplitMix64 (Steele, Lea, Flood 2014): a bijection of 64-bit words with good
/// avalanche.
constexpr std::uint64_t mix64(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// Returns a hash of a place on the ground. Equal keys and places give equal hashes.
constexpr std::uint64_t place_hash(std::uint64_t key, std::int32_t x, std::int32_t z) {
  return mix64(key ^ static_cast<std::uint32_t>(x) ^
               (std::uint64_t{static_cast<std::uint32_t>(z)} << 32));
}

/// Seeded stream of 64-bit words (SplitMix64). It gives the same numbers on every platform. It must
/// not be used for secrets.
class SplitMix64 {
 public:
  explicit constexpr SplitMix64(std::uint64_t seed) : state_(seed) {}
  constexpr std::uint64_t next() {
    const std::uint64_t out = mix64(state_);
    state_ += 0x9e3779b97f4a7c15ULL;
    return out;
  }
  /// Returns a number uniform in [0, bound) up to a bias below bound / 2^32 (multiply-shift).
  /// Requires 0 < bound.
  constexpr std::uint32_t below(std::uint32_t bound) {
    return static_cast<std::uint32_t>(((next() >> 32) * bound) >> 32);
  }
  /// Returns a number uniform in [low, high], both included. Requires low <= high.
  constexpr std::int32_t between(std::int32_t low, std::int32_t high) {
    const auto span = static_cast<std::uint32_t>(static_cast<std::int64_t>(high) - low + 1);
    return static_cast<std::int32_t>(low + static_cast<std::int64_t>(below(span)));
  }

 private:
  std::uint64_t state_;
};

}  // namespace runstone
