// SquareKey: a square of the ground, as a key of Recent.
#pragma once
#include <cstdint>

#include "common/core/hash.hpp"

namespace runstone {

/// A square of the ground, by its number along x and z.
struct SquareKey {
  std::int32_t x = 0, z = 0;
  friend bool operator==(const SquareKey&, const SquareKey&) = default;
};
constexpr std::uint64_t hash_of(const SquareKey& key) { return place_hash(0, key.x, key.z); }

}  // namespace runstone
