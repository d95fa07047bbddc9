// Digest: a sum over voxels that two holders of the same voxels compare. It detects drift and
// damage; it is not cryptographic.
//   chunk digest = sum over non-empty voxels of g(material) * A[x] * B[y] * C[z]  (mod 2^61 - 1)
//   world digest = sum over chunks of fold(key, chunk digest)
// Each digest has two lanes. Both digests are sums, so they do not depend on axis order, run
// boundaries, history or the order of visits, and an empty chunk adds nothing. A chunk digest
// covers local coordinates; world coordinates enter only through the chunk key.
#pragma once
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"

namespace runstone {

inline constexpr int kDigestLanes = 2;

struct Digest {
  std::array<std::uint64_t, kDigestLanes> lane{};  // each below 2^61 - 1
  friend auto operator<=>(const Digest&, const Digest&) = default;
};

Digest operator+(const Digest& a, const Digest& b);
Digest operator-(const Digest& a, const Digest& b);

/// Returns g(material) of one lane. It is 0 for kEmpty and never 0 for another material.
std::uint64_t digest_material(int lane, Material material);

/// Returns the sum of A, B or C (by axis) over first <= i < last, as the difference of two prefix
/// sums. Requires first <= last <= 128.
std::uint64_t digest_axis_sum(int lane, Axis axis, unsigned first, unsigned last);

/// Returns the prefix sums: entry i is digest_axis_sum(lane, axis, 0, i) for i <= 128. One more
/// entry repeats the last, so that a loop can read the pair (i, i + 1) at the end of an axis.
inline constexpr std::size_t kDigestPrefixCount = 130;
std::span<const std::uint64_t, kDigestPrefixCount> digest_axis_prefix(int lane, Axis axis);

/// Returns the digest of one box of one material inside a chunk. Coordinates are local, half-open,
/// 0 .. 128. Cost: O(1).
Digest digest_of_box(Material material, std::array<unsigned, 3> min, std::array<unsigned, 3> max);

/// Returns the term that one chunk adds to the world digest; it is zero for a zero digest. Source
/// of the idea: sum-based multiset hashing (Bellare and Micciancio 1997).
Digest world_digest_term(const ChunkKey& key, const Digest& chunk);

/// Returns 32 lower-case hex digits, lane 0 first.
std::string to_hex(const Digest& digest);

}  // namespace runstone
