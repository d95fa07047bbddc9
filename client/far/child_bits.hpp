// Child bits: sets of the children of a tile, one bit for each (tile_child()).
#pragma once
#include <cstdint>

#include "common/core/tile_keys.hpp"

namespace runstone {

inline constexpr std::uint8_t kAllChildren = 255;

/// Returns the bit of a tile or chunk in a set of its parent's children.
constexpr std::uint8_t child_bit(const ChunkKey& key) {
  return static_cast<std::uint8_t>(1U << child_index(key));
}
constexpr bool has_child(std::uint8_t bits, unsigned i) { return (bits >> i & 1U) != 0; }
constexpr std::uint8_t with_bit(std::uint8_t bits, std::uint8_t bit, bool is_set) {
  return static_cast<std::uint8_t>(is_set ? bits | bit : bits & ~bit);
}

}  // namespace runstone
