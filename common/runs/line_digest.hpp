// LineDigest: the digest's sum over voxels of one line of a chunk. The voxels of a line share two
// of the three factors of their places, so these are multiplied in once, by the caller.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "common/core/digest.hpp"
#include "common/core/m61.hpp"
#include "common/runs/material_factors.hpp"

namespace runstone {

class LineDigest {
 public:
  using Lanes = MaterialFactors::Lanes;  // each below 2^61 - 1

  /// `along` is the axis of the line, the fastest one of the chunk's order.
  explicit LineDigest(Axis along) {
    for (int lane = 0; lane < kDigestLanes; ++lane)
      prefix_[static_cast<std::size_t>(lane)] = digest_axis_prefix(lane, along).data();
  }

  /// Adds the voxels [first, last) of the line, each times `factors`. Requires last <= 128.
  void add(std::uint32_t first, std::uint32_t last, const Lanes& factors) {
    for (std::size_t lane = 0; lane < kDigestLanes; ++lane) {
      sum_[lane] += static_cast<m61::Wide>(m61::sub(prefix_[lane][last], prefix_[lane][first])) *
                    factors[lane];
    }
    if (++terms_ % kTermsPerReduction != 0) return;
    for (m61::Wide& sum : sum_) sum = m61::reduce_wide(sum);
  }
  /// Returns true if nothing was added since the last take().
  bool is_empty() const { return terms_ == 0; }
  /// Returns the sum and sets it to zero.
  Lanes take() {
    Lanes out;
    for (std::size_t lane = 0; lane < kDigestLanes; ++lane)
      out[lane] = m61::reduce_wide(sum_[lane]);
    sum_ = {};
    terms_ = 0;
    return out;
  }

 private:
  // A term is below 2^122, so this many terms and a reduced sum fit in 128 bits.
  static constexpr std::uint32_t kTermsPerReduction = 32;
  std::array<const std::uint64_t*, kDigestLanes> prefix_{};
  std::array<m61::Wide, kDigestLanes> sum_{};
  std::uint32_t terms_ = 0;
};

}  // namespace runstone
