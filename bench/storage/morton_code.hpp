// Morton codes: the bits of x, y and z interleaved, x lowest. Voxels that are near in space are
// mostly near in memory, and each aligned cube of 8, 64, 512 ... voxels is one stretch. Source:
// thesis 3.3.4; Morton 1966.
#pragma once
#include <array>
#include <cstdint>

#include "common/core/coords.hpp"

namespace runstone::bench::storage {

/// The bits of a code that belong to x, y and z: seven each, as chunks need.
inline constexpr std::array<std::uint32_t, 3> kMortonAxis = {0x49249, 0x92492, 0x124924};

/// Spreads bits by a table of 512 bytes.
struct MortonByTable {
  static constexpr auto kSpread = [] {
    std::array<std::uint32_t, 128> out{};
    for (std::uint32_t value = 0; value < 128; ++value) {
      for (std::uint32_t bit = 0; bit < 7; ++bit) out[value] |= (value >> bit & 1u) << (3 * bit);
    }
    return out;
  }();
  static std::uint32_t code(LocalPos at) {
    return kSpread[at.x] | kSpread[at.y] << 1 | kSpread[at.z] << 2;
  }
};

#if defined(__x86_64__)
/// Spreads bits by the instruction pdep. Requires a processor with BMI2 (morton_by_pdep()).
struct MortonByPdep {
  static std::uint32_t code(LocalPos at) {
    return deposit(at.x, kMortonAxis[0]) | deposit(at.y, kMortonAxis[1]) |
           deposit(at.z, kMortonAxis[2]);
  }

 private:
  // The intrinsic is not used: a function for BMI2 is never inlined into a function for any x86-64,
  // and the call would cost more than the instruction.
  static std::uint32_t deposit(std::uint32_t bits, std::uint32_t mask) {
    std::uint32_t out = 0;
    __asm__("pdep %2, %1, %0" : "=r"(out) : "r"(bits), "r"(mask));
    return out;
  }
};
inline bool morton_by_pdep() { return __builtin_cpu_supports("bmi2") != 0; }
#else
using MortonByPdep = MortonByTable;
inline bool morton_by_pdep() { return false; }
#endif

/// Returns the next code along an axis whose bits are `axis`. Wraps at the end of its seven bits.
constexpr std::uint32_t morton_next(std::uint32_t code, std::uint32_t axis) {
  return (code & ~axis) | (((code & axis) - axis) & axis);
}

}  // namespace runstone::bench::storage
