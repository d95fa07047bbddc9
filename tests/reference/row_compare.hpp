// Comparison of adjacent voxels, up to 64 in a word of 64 bits: of materials, and of palette ids,
// which are bytes. SSE2 is part of every x86-64; on other machines a loop makes the same words.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "common/core/ids.hpp"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace runstone::reference {

/// Returns the lowest `count` bits. Requires 0 < count <= 64.
constexpr std::uint64_t low_bits(std::uint32_t count) {
  // The mask costs nothing and bounds the shift for analysers.
  return ~std::uint64_t{0} >> ((64 - count) & 63);
}

/// The number of voxels that a comparison may read beyond the last one that it compares.
inline constexpr std::size_t kCompareSlack = 16;

/// Returns a word with bit i set if a[i] != b[i], for i < count. Requires 0 < count <= 64 and
/// kCompareSlack readable materials behind both.
inline std::uint64_t differing_bits(const Material* a, const Material* b, std::uint32_t count) {
  std::uint64_t equal = 0;
#if defined(__SSE2__)
  const auto eight = [&](std::uint32_t i) {
    return _mm_cmpeq_epi16(_mm_loadu_si128(reinterpret_cast<const __m128i*>(a + i)),
                           _mm_loadu_si128(reinterpret_cast<const __m128i*>(b + i)));
  };
  for (std::uint32_t i = 0; i < count; i += 16) {
    const auto bits =
        static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_packs_epi16(eight(i), eight(i + 8))));
    equal |= std::uint64_t{bits} << i;
  }
#else
  for (std::uint32_t i = 0; i < count; ++i) equal |= std::uint64_t{a[i] == b[i]} << i;
#endif
  return ~equal & low_bits(count);
}

/// Returns how many of the `count` materials from `row` on equal `material`, before the first that
/// differs. Requires kCompareSlack readable materials behind them.
inline std::uint32_t equal_prefix(const Material* row, std::uint32_t count, Material material) {
  std::uint32_t i = 0;
#if defined(__SSE2__)
  const __m128i wanted = _mm_set1_epi16(static_cast<short>(material));
  for (; i < count; i += 8) {
    const __m128i here = _mm_loadu_si128(reinterpret_cast<const __m128i*>(row + i));
    const auto other =
        static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_cmpeq_epi16(here, wanted))) ^ 0xffffu;
    if (other != 0) {
      i += static_cast<std::uint32_t>(__builtin_ctz(other)) / 2;
      break;
    }
  }
  return i < count ? i : count;
#else
  while (i < count && row[i] == material) ++i;
  return i;
#endif
}

/// The same for palette ids.
inline std::uint64_t differing_bits(const std::uint8_t* a, const std::uint8_t* b,
                                    std::uint32_t count) {
  std::uint64_t equal = 0;
#if defined(__SSE2__)
  for (std::uint32_t i = 0; i < count; i += 16) {
    const __m128i same = _mm_cmpeq_epi8(_mm_loadu_si128(reinterpret_cast<const __m128i*>(a + i)),
                                        _mm_loadu_si128(reinterpret_cast<const __m128i*>(b + i)));
    equal |= std::uint64_t{static_cast<std::uint32_t>(_mm_movemask_epi8(same))} << i;
  }
#else
  for (std::uint32_t i = 0; i < count; ++i) equal |= std::uint64_t{a[i] == b[i]} << i;
#endif
  return ~equal & low_bits(count);
}

inline std::uint32_t equal_prefix(const std::uint8_t* row, std::uint32_t count, std::uint8_t id) {
  std::uint32_t i = 0;
#if defined(__SSE2__)
  const __m128i wanted = _mm_set1_epi8(static_cast<char>(id));
  for (; i < count; i += 16) {
    const __m128i here = _mm_loadu_si128(reinterpret_cast<const __m128i*>(row + i));
    const auto other =
        static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_cmpeq_epi8(here, wanted))) ^ 0xffffu;
    if (other != 0) {
      i += static_cast<std::uint32_t>(__builtin_ctz(other));
      break;
    }
  }
  return i < count ? i : count;
#else
  while (i < count && row[i] == id) ++i;
  return i;
#endif
}

}  // namespace runstone::reference
