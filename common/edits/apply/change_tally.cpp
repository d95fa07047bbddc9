#include "common/edits/apply/change_tally.hpp"

#include <algorithm>

#include "common/core/assert.hpp"
#include "common/core/m61.hpp"

namespace runstone {

namespace {

using m61::reduce_wide;
using m61::Wide;

// A term with factors below 2^62 is below 2^124, so this many terms and a reduced sum fit in 128
// bits.
constexpr std::uint32_t kOpenTermsPerReduction = 8;

// Returns layers first .. last - 1 of `count`. A `last` beyond the count continues from 0.
LineBits layers_around(std::uint32_t first, std::uint32_t last, std::uint32_t count) {
  if (last - first >= count) return bits_below(count);
  if (last <= count) return bits_between(first, last);
  return bits_between(first, count) | bits_below(last - count);
}

}  // namespace

ChangeTally::ChangeTally(const RunChunk& shape, std::vector<Change>& changes,
                         MaterialFactors& factors, Want want)
    : want_(want),
      shape_(shape),
      extent_(ordered(shape.extent, shape.order)),
      changes_(changes),
      factors_(factors),
      line_digest_(axes_of(shape.order)[0]) {
  RUNSTONE_DASSERT(changes.empty());
  const auto axes = axes_of(shape.order);
  for (std::size_t rank = 0; rank < 3; ++rank) {
    for (std::size_t lane = 0; lane < kDigestLanes; ++lane)
      prefixes_[rank][lane] = digest_axis_prefix(static_cast<int>(lane), axes[rank]).data();
  }
}

void ChangeTally::open_line(VoxelIndex first) {
  close_line();
  line_begin_ = first / extent_.f * extent_.f;
  line_end_ = line_begin_ + extent_.f;
}

void ChangeTally::close_line() {
  if (line_digest_.is_empty()) return;
  const std::uint32_t line = line_begin_ / extent_.f;
  const std::uint32_t s = line / extent_.m;
  const std::uint32_t m = line - s * extent_.m;
  const LineDigest::Lanes sum = line_digest_.take();
  for (std::size_t k = 0; k < kDigestLanes; ++k) {
    const std::uint64_t across = m61::mul(factor_at(k, 1, m), factor_at(k, 2, s));
    digest_.lane[k] = m61::add(digest_.lane[k], m61::mul(sum[k], across));
  }
  dirty_[1] = dirty_[1] | bits_between(m, m + 1);
  dirty_[2] = dirty_[2] | bits_between(s, s + 1);
}

void ChangeTally::in_line(std::uint32_t first, std::uint32_t last, Material before,
                          Material after) {
  const MaterialFactors::Lanes was = factors_.of(before);  // a copy: both may share a slot
  const MaterialFactors::Lanes& is = factors_.of(after);
  LineDigest::Lanes change;
  for (std::size_t k = 0; k < kDigestLanes; ++k) change[k] = m61::sub(is[k], was[k]);
  line_digest_.add(first, last, change);
  dirty_[0] = dirty_[0] | bits_between(first, last);
}

void ChangeTally::line(std::uint32_t m, std::uint32_t s, LineBits changed, LineBits cuts,
                       const Material* before, const Material* after) {
  if (s != layer_) {
    close_layer();
    layer_ = s;
  }
  const VoxelIndex begin = (s * extent_.m + m) * extent_.f;
  if (want_ == Want::changes) return note_line(begin, changed, cuts, after);
  const Prefixes prefix = prefixes_[0];
  std::array<Wide, kDigestLanes> sum{};
  std::uint32_t terms = 0;
  dirty_[0] = dirty_[0] | changed;
  dirty_[1] = dirty_[1] | bits_between(m, m + 1);
  dirty_[2] = dirty_[2] | bits_between(s, s + 1);
  cuts = cuts | ~changed;
  while (changed.any()) {
    const std::uint32_t first = changed.lowest();
    const std::uint32_t last = std::min((cuts & ~bits_below(first + 1)).lowest(), extent_.f);
    changed = changed & ~bits_below(last);
    voxels_ += last - first;
    note(begin + first, begin + last, after[first]);
    const MaterialFactors::Lanes was = factors_.of(before[first]);  // a copy: both may share a slot
    const MaterialFactors::Lanes& is = factors_.of(after[first]);
    for (std::size_t lane = 0; lane < kDigestLanes; ++lane) {
      // Two differences below 2^62, not reduced.
      const std::uint64_t along = prefix[lane][last] + m61::kPrime - prefix[lane][first];
      sum[lane] += static_cast<Wide>(along) * (is[lane] + m61::kPrime - was[lane]);
    }
    if (++terms % kOpenTermsPerReduction == 0) {
      for (Wide& lane : sum) lane = reduce_wide(lane);
    }
  }
  for (std::size_t lane = 0; lane < kDigestLanes; ++lane) {
    layer_sum_[lane] =
        m61::add(layer_sum_[lane], m61::mul(reduce_wide(sum[lane]), factor_at(lane, 1, m)));
  }
}

void ChangeTally::note_line(VoxelIndex begin, LineBits changed, LineBits cuts,
                            const Material* after) {
  cuts = cuts | ~changed;
  while (changed.any()) {
    const std::uint32_t first = changed.lowest();
    const std::uint32_t last = std::min((cuts & ~bits_below(first + 1)).lowest(), extent_.f);
    changed = changed & ~bits_below(last);
    note(begin + first, begin + last, after[first]);
  }
}

// All lines of a layer share the third factor.
void ChangeTally::close_layer() {
  for (std::size_t lane = 0; lane < kDigestLanes; ++lane) {
    digest_.lane[lane] =
        m61::add(digest_.lane[lane], m61::mul(layer_sum_[lane], factor_at(lane, 2, layer_)));
    layer_sum_[lane] = 0;
  }
}

void ChangeTally::across_lines(VoxelIndex first, VoxelIndex last, Material before, Material after) {
  digest_ = digest_ - digest_of_span(shape_, first, last, before) +
            digest_of_span(shape_, first, last, after);
  const std::uint32_t f = first - line_begin_;
  dirty_[0] = dirty_[0] | layers_around(f, f + (last - first), extent_.f);
  const std::uint32_t line = first / extent_.f;
  const std::uint32_t line_last = (last - 1) / extent_.f;
  const std::uint32_t m = line % extent_.m;
  dirty_[1] = dirty_[1] | layers_around(m, m + (line_last - line) + 1, extent_.m);
  dirty_[2] = dirty_[2] | bits_between(line / extent_.m, line_last / extent_.m + 1);
}

void ChangeTally::finish() {
  close_line();
  close_layer();
}

DirtyLayers ChangeTally::dirty() const {
  DirtyLayers out;
  const auto axes = axes_of(shape_.order);
  for (std::size_t i = 0; i < 3; ++i)
    out.layer[static_cast<std::size_t>(axes[i])] = dirty_[i].to_bitset();
  return out;
}

}  // namespace runstone
