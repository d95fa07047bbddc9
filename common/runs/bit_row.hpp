// Bit rows: one line of a layer as bits, in the narrowest integer that holds it: a Row32 for sides
// up to 32, a Row64 for sides up to 64, a Row128 for longer ones. Code that works on rows is a
// template over the three.
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace runstone {

using Row32 = std::uint32_t;
using Row64 = std::uint64_t;
__extension__ using Row128 = unsigned __int128;

template <class Row>
inline constexpr unsigned kRowBits = sizeof(Row) * 8;

/// Returns a row with bits [0, count) set. Requires count <= kRowBits.
template <class Row>
constexpr Row bits_below(unsigned count) {
  return count == kRowBits<Row> ? ~Row{0} : (Row{1} << count) - 1;
}

/// Returns the place of the lowest set bit, or kRowBits<Row> if there is none.
constexpr unsigned lowest_bit(Row32 row) { return static_cast<unsigned>(std::countr_zero(row)); }
constexpr unsigned lowest_bit(Row64 row) { return static_cast<unsigned>(std::countr_zero(row)); }
constexpr unsigned lowest_bit(Row128 row) {
  const auto low = static_cast<Row64>(row);
  return low != 0 ? lowest_bit(low) : 64 + lowest_bit(static_cast<Row64>(row >> 64));
}

constexpr unsigned bit_count(Row32 row) { return static_cast<unsigned>(std::popcount(row)); }
constexpr unsigned bit_count(Row64 row) { return static_cast<unsigned>(std::popcount(row)); }
constexpr unsigned bit_count(Row128 row) {
  return bit_count(static_cast<Row64>(row)) + bit_count(static_cast<Row64>(row >> 64));
}

/// Returns the place of the highest set bit. Requires row != 0.
constexpr unsigned highest_bit(Row32 row) {
  return 31u - static_cast<unsigned>(std::countl_zero(row));
}
constexpr unsigned highest_bit(Row64 row) {
  return 63u - static_cast<unsigned>(std::countl_zero(row));
}
constexpr unsigned highest_bit(Row128 row) {
  const auto high = static_cast<Row64>(row >> 64);
  return high != 0 ? 64 + highest_bit(high) : highest_bit(static_cast<Row64>(row));
}

/// Returns a row whose bit i is the parity of bits [0, i] of `row`. It turns marks of changes into
/// states.
template <class Row>
constexpr Row prefix_xor(Row row) {
  for (unsigned shift = 1; shift < kRowBits<Row>; shift *= 2) row ^= row << shift;
  return row;
}

/// Transposes a square of kRowBits rows of bits. Source: recursive block swap (Hacker's Delight,
/// 7-3).
template <class Row>
void transpose(std::array<Row, kRowBits<Row>>& rows) {
  Row mask = bits_below<Row>(kRowBits<Row> / 2);
  for (unsigned width = kRowBits<Row> / 2; width != 0; width /= 2, mask ^= mask << width) {
    for (unsigned r = 0; r < kRowBits<Row>; r = (r + width + 1) & ~width) {
      const Row swap = ((rows[r] >> width) ^ rows[r + width]) & mask;
      rows[r] ^= swap << width;
      rows[r + width] ^= swap;
    }
  }
}

}  // namespace runstone
