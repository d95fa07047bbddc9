#include "common/edits/apply/change_tally.hpp"

#include <algorithm>

#include "common/core/assert.hpp"
#include "common/core/m61.hpp"

namespace runstone {

// The digest's axis sums from 0 up to each coordinate. They are computed once, because the tally
// needs two per changed stretch.
struct AxisSums {
  using PrefixSums = std::array<std::uint64_t, kSideMax + 1>;
  std::array<std::array<PrefixSums, 3>, kDigestLanes> sums;
  AxisSums() {
    for (std::size_t lane = 0; lane < kDigestLanes; ++lane) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (unsigned i = 0; i <= kSideMax; ++i) {
          sums[lane][axis][i] =
              digest_axis_sum(static_cast<int>(lane), static_cast<Axis>(axis), 0, i);
        }
      }
    }
  }
  std::uint64_t between(std::size_t lane, Axis axis, std::uint32_t first,
                        std::uint32_t last) const {
    const PrefixSums& prefix = sums[lane][static_cast<std::size_t>(axis)];
    return m61::sub(prefix[last], prefix[first]);
  }
};

namespace {

const AxisSums& axis_sums() {
  static const AxisSums table;
  return table;
}

using m61::reduce_wide;
using m61::Wide;

// A term is below 2^122, so this many terms and a reduced sum fit in 128 bits.
constexpr std::uint32_t kTermsPerReduction = 32;
// The same bound for factors below 2^62.
constexpr std::uint32_t kOpenTermsPerReduction = 8;

// Returns layers first .. last - 1 of `count`. A `last` beyond the count continues from 0.
LineBits layers_around(std::uint32_t first, std::uint32_t last, std::uint32_t count) {
  if (last - first >= count) return bits_below(count);
  if (last <= count) return bits_between(first, last);
  return bits_between(first, count) | bits_below(last - count);
}

}  // namespace

ChangeTally::ChangeTally(const RunChunk& shape, std::vector<Change>& changes,
                         MaterialFactors& factors)
    : shape_(shape),
      sums_(axis_sums()),
      extent_(ordered(shape.extent, shape.order)),
      axes_(axes_of(shape.order)),
      changes_(changes),
      factors_(factors) {
  RUNSTONE_DASSERT(changes.empty());
}

void ChangeTally::open_line(VoxelIndex first) {
  close_line();
  line_begin_ = first / extent_.f * extent_.f;
  line_end_ = line_begin_ + extent_.f;
}

// All stretches of a line share two of the three factors. They are multiplied in here, once.
void ChangeTally::close_line() {
  if (line_terms_ == 0) return;
  const std::uint32_t line = line_begin_ / extent_.f;
  const std::uint32_t s = line / extent_.m;
  const std::uint32_t m = line - s * extent_.m;
  for (std::size_t lane = 0; lane < kDigestLanes; ++lane) {
    const std::uint64_t across =
        m61::mul(sums_.between(lane, axes_[1], m, m + 1), sums_.between(lane, axes_[2], s, s + 1));
    digest_.lane[lane] =
        m61::add(digest_.lane[lane], m61::mul(reduce_wide(line_sum_[lane]), across));
    line_sum_[lane] = 0;
  }
  line_terms_ = 0;
  dirty_[1] = dirty_[1] | bits_between(m, m + 1);
  dirty_[2] = dirty_[2] | bits_between(s, s + 1);
}

void ChangeTally::in_line(std::uint32_t first, std::uint32_t last, Material before,
                          Material after) {
  const MaterialFactors::Lanes was = factors_.of(before);  // a copy: both may share a slot
  const MaterialFactors::Lanes& is = factors_.of(after);
  for (std::size_t lane = 0; lane < kDigestLanes; ++lane) {
    line_sum_[lane] += static_cast<Wide>(sums_.between(lane, axes_[0], first, last)) *
                       m61::sub(is[lane], was[lane]);
  }
  if (++line_terms_ % kTermsPerReduction == 0) {
    for (Wide& sum : line_sum_) sum = reduce_wide(sum);
  }
  dirty_[0] = dirty_[0] | bits_between(first, last);
}

void ChangeTally::line(std::uint32_t m, std::uint32_t s, LineBits changed, LineBits cuts,
                       const Material* before, const Material* after) {
  if (s != layer_) {
    close_layer();
    layer_ = s;
  }
  const VoxelIndex begin = (s * extent_.m + m) * extent_.f;
  std::array<const std::uint64_t*, kDigestLanes> prefix;
  for (std::size_t lane = 0; lane < kDigestLanes; ++lane) {
    prefix[lane] = sums_.sums[lane][static_cast<std::size_t>(axes_[0])].data();
  }
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
    const std::uint64_t at_m = sums_.between(lane, axes_[1], m, m + 1);
    layer_sum_[lane] = m61::add(layer_sum_[lane], m61::mul(reduce_wide(sum[lane]), at_m));
  }
}

// All lines of a layer share the third factor.
void ChangeTally::close_layer() {
  for (std::size_t lane = 0; lane < kDigestLanes; ++lane) {
    const std::uint64_t at_s = sums_.between(lane, axes_[2], layer_, layer_ + 1);
    digest_.lane[lane] = m61::add(digest_.lane[lane], m61::mul(layer_sum_[lane], at_s));
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
  for (std::size_t i = 0; i < 3; ++i)
    out.layer[static_cast<std::size_t>(axes_[i])] = dirty_[i].to_bitset();
  return out;
}

}  // namespace runstone
