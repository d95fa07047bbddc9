#include "common/core/digest.hpp"

#include "common/core/assert.hpp"
#include "common/core/hash.hpp"
#include "common/core/hex.hpp"
#include "common/core/m61.hpp"

namespace runstone {
namespace {

constexpr unsigned kSideMax = 128;
constexpr std::uint64_t kAxisSalt = 0x52756e73746f6e65ULL;  // "Runstone"
constexpr std::uint64_t kMaterialSalt = 0x4d6174657269616cULL;
constexpr std::uint64_t kWorldSalt = 0x576f726c64466f6cULL;

// Returns a residue that is never 0: a zero factor would hide every voxel that it multiplies.
constexpr std::uint64_t nonzero_residue(std::uint64_t seed) {
  return 1 + mix64(seed) % (m61::kPrime - 1);
}

using PrefixSums = std::array<std::uint64_t, kDigestPrefixCount>;
static_assert(kDigestPrefixCount == kSideMax + 2);
using Tables = std::array<std::array<PrefixSums, 3>, kDigestLanes>;

constexpr Tables make_tables() {
  Tables tables{};
  for (std::size_t lane = 0; lane < kDigestLanes; ++lane) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::uint64_t sum = 0;
      for (std::size_t i = 0; i < kSideMax; ++i) {
        tables[lane][axis][i] = sum;
        sum = m61::add(sum, nonzero_residue(kAxisSalt ^ (lane << 16 | axis << 8 | i)));
      }
      tables[lane][axis][kSideMax] = sum;
      tables[lane][axis][kSideMax + 1] = sum;
    }
  }
  return tables;
}

constexpr Tables kPrefix = make_tables();

}  // namespace

Digest operator+(const Digest& a, const Digest& b) {
  return {{m61::add(a.lane[0], b.lane[0]), m61::add(a.lane[1], b.lane[1])}};
}

Digest operator-(const Digest& a, const Digest& b) {
  return {{m61::sub(a.lane[0], b.lane[0]), m61::sub(a.lane[1], b.lane[1])}};
}

std::uint64_t digest_material(int lane, Material material) {
  if (material == kEmpty) return 0;
  return nonzero_residue(kMaterialSalt ^ (static_cast<std::uint64_t>(lane) << 32) ^ material);
}

std::uint64_t digest_axis_sum(int lane, Axis axis, unsigned first, unsigned last) {
  RUNSTONE_DASSERT(first <= last && last <= kSideMax);
  const PrefixSums& sums = kPrefix[static_cast<std::size_t>(lane)][static_cast<std::size_t>(axis)];
  return m61::sub(sums[last], sums[first]);
}

std::span<const std::uint64_t, kDigestPrefixCount> digest_axis_prefix(int lane, Axis axis) {
  return kPrefix[static_cast<std::size_t>(lane)][static_cast<std::size_t>(axis)];
}

Digest digest_of_box(Material material, std::array<unsigned, 3> min, std::array<unsigned, 3> max) {
  Digest out;
  if (material == kEmpty) return out;
  for (int lane = 0; lane < kDigestLanes; ++lane) {
    const std::uint64_t xy = m61::mul(digest_axis_sum(lane, Axis::x, min[0], max[0]),
                                      digest_axis_sum(lane, Axis::y, min[1], max[1]));
    const std::uint64_t xyz = m61::mul(xy, digest_axis_sum(lane, Axis::z, min[2], max[2]));
    out.lane[static_cast<std::size_t>(lane)] = m61::mul(xyz, digest_material(lane, material));
  }
  return out;
}

Digest world_digest_term(const ChunkKey& key, const Digest& chunk) {
  // A linear fold, one factor per key, would let equal errors in two chunks cancel too easily. So
  // the chunk's residue is mixed before it is added.
  if (chunk == Digest{}) return {};
  Digest out;
  for (std::size_t lane = 0; lane < kDigestLanes; ++lane) {
    std::uint64_t h = mix64(kWorldSalt ^ lane ^ (static_cast<std::uint64_t>(key.lod) << 8));
    h = mix64(h ^ static_cast<std::uint32_t>(key.at.x));
    h = mix64(h ^ static_cast<std::uint32_t>(key.at.y));
    h = mix64(h ^ static_cast<std::uint32_t>(key.at.z));
    h = mix64(h ^ chunk.lane[0]);
    h = mix64(h ^ chunk.lane[1]);
    out.lane[lane] = m61::reduce(h);
  }
  return out;
}

std::string to_hex(const Digest& digest) {
  // The highest byte of a lane comes first.
  std::array<std::uint8_t, 8 * kDigestLanes> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<std::uint8_t>(digest.lane[i / 8] >> (56 - 8 * (i % 8)));
  }
  return to_hex(ByteView(bytes));
}

}  // namespace runstone
