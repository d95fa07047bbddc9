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

#if defined(__SSE2__)
/// Return all bits of a lane if the voxels there are equal. A register has 16 / sizeof(Voxel)
/// lanes.
inline __m128i equal_lanes(__m128i a, __m128i b, std::uint8_t) { return _mm_cmpeq_epi8(a, b); }
inline __m128i equal_lanes(__m128i a, __m128i b, std::uint16_t) { return _mm_cmpeq_epi16(a, b); }
inline __m128i splat(std::uint8_t voxel) { return _mm_set1_epi8(static_cast<char>(voxel)); }
inline __m128i splat(std::uint16_t voxel) { return _mm_set1_epi16(static_cast<short>(voxel)); }
template <class Voxel>
__m128i load_lanes(const Voxel* from) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
}
inline std::uint32_t byte_mask(__m128i lanes) {
  return static_cast<std::uint32_t>(_mm_movemask_epi8(lanes));
}
#endif

/// Returns a word with bit i set if a[i] != b[i], for i < count. Requires 0 < count <= 64 and
/// kCompareSlack readable voxels behind both. Voxel is Material or a byte.
template <class Voxel>
std::uint64_t differing_bits(const Voxel* a, const Voxel* b, std::uint32_t count) {
  std::uint64_t equal = 0;
#if defined(__SSE2__)
  const auto equal_at = [&](std::uint32_t i) {
    return equal_lanes(load_lanes(a + i), load_lanes(b + i), Voxel{});
  };
  for (std::uint32_t i = 0; i < count; i += 16) {
    __m128i sixteen = equal_at(i);
    if constexpr (sizeof(Voxel) == 2) sixteen = _mm_packs_epi16(sixteen, equal_at(i + 8));
    equal |= std::uint64_t{byte_mask(sixteen)} << i;
  }
#else
  for (std::uint32_t i = 0; i < count; ++i) equal |= std::uint64_t{a[i] == b[i]} << i;
#endif
  return ~equal & low_bits(count);
}

/// Returns a word with bit i set if ids[i] < limit, for i < count. Requires 0 < count <= 64, a
/// limit of at most 256, and kCompareSlack readable ids behind them.
inline std::uint64_t ids_below(const std::uint8_t* ids, std::uint32_t count, std::uint32_t limit) {
  if (limit == 0) return 0;
  std::uint64_t below = 0;
#if defined(__SSE2__)
  const __m128i highest = splat(static_cast<std::uint8_t>(limit - 1));
  for (std::uint32_t i = 0; i < count; i += 16) {
    const __m128i lanes = load_lanes(ids + i);
    below |= std::uint64_t{byte_mask(_mm_cmpeq_epi8(_mm_min_epu8(lanes, highest), lanes))} << i;
  }
#else
  for (std::uint32_t i = 0; i < count; ++i) below |= std::uint64_t{ids[i] < limit} << i;
#endif
  return below & low_bits(count);
}

/// Returns how many of the `count` voxels from `row` on equal `voxel`, before the first that
/// differs. Requires kCompareSlack readable voxels behind them.
template <class Voxel>
std::uint32_t equal_prefix(const Voxel* row, std::uint32_t count, Voxel voxel) {
  std::uint32_t i = 0;
#if defined(__SSE2__)
  constexpr std::uint32_t kLanes = 16 / sizeof(Voxel);
  const __m128i wanted = splat(voxel);
  for (; i < count; i += kLanes) {
    const std::uint32_t other =
        byte_mask(equal_lanes(load_lanes(row + i), wanted, voxel)) ^ 0xffffu;
    if (other == 0) continue;
    i += static_cast<std::uint32_t>(__builtin_ctz(other)) * kLanes / 16;
    break;
  }
  return i < count ? i : count;
#else
  while (i < count && row[i] == voxel) ++i;
  return i;
#endif
}

}  // namespace runstone::reference
