// Digest: what two holders of the same voxels compare. It detects drift and damage; it is not cryptographic.
//   chunk digest = sum over non-empty voxels of g(material) * A[x] * B[y] * C[z]  (mod 2^61 - 1), in two
//   lanes world digest = sum over chunks of fold(key, chunk digest)
// Both are sums, so neither depends on axis order, run boundaries, history or the order of visits, and an
// all-empty chunk adds nothing. Local coordinates enter, world coordinates only through the chunk key.
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

/// g(material) of one lane; never 0 for a non-empty material, and 0 for kEmpty.
std::uint64_t digest_material(int lane, Material material);

/// Sum over first <= i < last of A, B or C (by axis) at i: a difference of two prefix sums. last <= 128.
std::uint64_t digest_axis_sum(int lane, Axis axis, unsigned first, unsigned last);

/// The prefix sums themselves: entry i is digest_axis_sum(lane, axis, 0, i) for i <= 128, and one entry more
/// repeats the last, so that a loop may read the pair (i, i + 1) at the end of an axis.
inline constexpr std::size_t kDigestPrefixCount = 130;
std::span<const std::uint64_t, kDigestPrefixCount> digest_axis_prefix(int lane, Axis axis);

/// Digest of one box of one material inside a chunk (local, half-open coordinates 0 .. 128). O(1).
Digest digest_of_box(Material material, std::array<unsigned, 3> min, std::array<unsigned, 3> max);

/// What one chunk adds to the world digest; zero for a zero digest. Source of the idea: sum-based multiset
/// hashing (Bellare and Micciancio 1997).
Digest world_digest_term(const ChunkKey& key, const Digest& chunk);

/// 32 lower-case hex digits, lane 0 first.
std::string to_hex(const Digest& digest);

}  // namespace runstone
