#include "common/mesh/rdm/quad_splice.hpp"

#include <algorithm>
#include <cstring>

namespace runstone::rdm {

void QuadSplice::apply(QuadLayers& out) {
  if (stretches_.empty()) return;
  const std::size_t count = stretches_.size(), size = out.quads.size();
  shift_.resize(count);
  std::ptrdiff_t shift = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Stretch& s = stretches_[i];
    shift += static_cast<std::ptrdiff_t>(s.count) - static_cast<std::ptrdiff_t>(s.end - s.begin);
    shift_[i] = shift;
  }
  const std::size_t size_after = size + static_cast<std::size_t>(shift);
  if (size_after > size) out.quads.resize(size_after);
  Quad* const quads = out.quads.data();
  const auto move = [&](std::size_t i) {
    const std::size_t begin = stretches_[i].end;
    const std::size_t end = i + 1 == count ? size : stretches_[i + 1].begin;
    std::memmove(quads + static_cast<std::ptrdiff_t>(begin) + shift_[i], quads + begin,
                 (end - begin) * sizeof(Quad));
  };
  // Call the quads between two stretches a gap. Gaps that move down are moved first, in ascending
  // order. Then the gaps that move up are moved, in descending order. No gap is overwritten before
  // it is moved:
  //   - The targets of the gaps are as disjoint, and in the same order, as the gaps.
  //   - Gap i moves down, to a target below its present end. Gaps after it are above that end. A gap
  //     j before it that has not been moved will move up, or stays. So gap j is not above its own
  //     target, and that is below the target of gap i.
  //   - The argument for gaps that move up is this one with up and down exchanged.
  for (std::size_t i = 0; i < count; ++i) {
    if (shift_[i] < 0) move(i);
  }
  for (std::size_t i = count; i-- != 0;) {
    if (shift_[i] > 0) move(i);
  }
  std::uint32_t* const first = out.first.data();
  for (std::size_t i = 0; i < count; ++i) {
    const Stretch& s = stretches_[i];
    std::copy_n(s.quads, s.count,
                quads + static_cast<std::ptrdiff_t>(s.begin) + (i == 0 ? 0 : shift_[i - 1]));
    const std::size_t end = i + 1 == count ? out.first.size() : stretches_[i + 1].layer + 1;
    const auto more = static_cast<std::uint32_t>(shift_[i]);  // modulo 2^32
    for (std::size_t l = s.layer + 1; l < end; ++l) first[l] += more;
  }
  out.quads.resize(size_after);
}

}  // namespace runstone::rdm
