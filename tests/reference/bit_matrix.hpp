// The transposition of a matrix of 64 x 64 bits in place. Source: recursive block swaps (Warren,
// Hacker's Delight, 7-3).
#pragma once
#include <cstdint>

namespace runstone::reference {

/// Moves bit c of rows[r] to bit r of rows[c].
inline void transpose_bits(std::uint64_t* rows) {
  std::uint64_t low = 0xffff'ffff;  // the lower one of each pair of blocks of `side` bits
  for (unsigned side = 32; side != 0; side /= 2, low ^= low << side) {
    for (unsigned block = 0; block < 64; block += 2 * side) {
      for (unsigned r = block; r < block + side; ++r) {
        const std::uint64_t swap = ((rows[r] >> side) ^ rows[r + side]) & low;
        rows[r] ^= swap << side;
        rows[r + side] ^= swap;
      }
    }
  }
}

}  // namespace runstone::reference
