// LineBits: one bit per voxel of a line, which has at most 128 voxels. Internal to edits.
#pragma once
#include <array>
#include <bit>
#include <bitset>
#include <cstdint>
#include <cstring>

#include "common/core/ids.hpp"
#include "common/runs/extent.hpp"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace runstone {

struct LineBits {
  std::uint64_t low = 0, high = 0;
  friend bool operator==(const LineBits&, const LineBits&) = default;
  friend constexpr LineBits operator&(LineBits a, LineBits b) {
    return {a.low & b.low, a.high & b.high};
  }
  friend constexpr LineBits operator|(LineBits a, LineBits b) {
    return {a.low | b.low, a.high | b.high};
  }
  constexpr LineBits operator~() const { return {~low, ~high}; }
  constexpr bool any() const { return (low | high) != 0; }
  /// Returns the place of the lowest set bit, or 128 if there is none.
  constexpr unsigned lowest() const {
    return static_cast<unsigned>(low != 0 ? std::countr_zero(low) : 64 + std::countr_zero(high));
  }
  std::bitset<kSideMax> to_bitset() const {
    return std::bitset<kSideMax>(low) | (std::bitset<kSideMax>(high) << 64);
  }
};
static_assert(kSideMax == 128);

namespace detail {
constexpr std::array<LineBits, kSideMax + 1> make_bits_below() {
  std::array<LineBits, kSideMax + 1> out{};
  for (std::size_t n = 1; n <= kSideMax; ++n) {
    out[n] = out[n - 1];
    (n <= 64 ? out[n].low : out[n].high) |= std::uint64_t{1} << ((n - 1) % 64);
  }
  return out;
}
inline constexpr auto kBitsBelow = make_bits_below();
}  // namespace detail

/// Returns bits 0 .. n - 1. Requires n <= 128.
constexpr LineBits bits_below(std::uint32_t n) { return detail::kBitsBelow[n]; }
/// Returns bits first .. last - 1.
constexpr LineBits bits_between(std::uint32_t first, std::uint32_t last) {
  return bits_below(last) & ~bits_below(first);
}

/// Returns bits i < count for which a[i] != b[i]. Requires count <= 128. This is the plain form and
/// the reference for differing().
inline LineBits differing_plain(const Material* a, const Material* b, std::uint32_t count) {
  LineBits out;
  for (std::uint32_t i = 0; i < count; ++i) {
    (i < 64 ? out.low : out.high) |= static_cast<std::uint64_t>(a[i] != b[i]) << (i % 64);
  }
  return out;
}

/// Returns the bits of differing_plain(). Compares 16 voxels a step if the CPU has SSE2. Requires
/// both arrays to be readable up to the next multiple of 16.
inline LineBits differing(const Material* a, const Material* b, std::uint32_t count) {
#ifdef __SSE2__
  std::array<std::uint64_t, 2> word{};
  for (std::uint32_t i = 0; i < count; i += 16) {
    const auto load = [i](const Material* from) {
      return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from + i));
    };
    const __m128i low = _mm_cmpeq_epi16(load(a), load(b));
    const __m128i high = _mm_cmpeq_epi16(load(a + 8), load(b + 8));
    const auto equal = static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_packs_epi16(low, high)));
    word[i / 64] |= static_cast<std::uint64_t>(equal ^ 0xffffu) << (i % 64);
  }
  return LineBits{word[0], word[1]} & bits_below(count);
#else
  return differing_plain(a, b, count);
#endif
}

}  // namespace runstone
