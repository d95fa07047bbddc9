#include "common/patterns/height_ranges.hpp"

namespace runstone {

HeightRanges union_of(const HeightRanges& a, const HeightRanges& b) {
  HeightRanges out;
  for (std::size_t i = 0, k = 0; i < a.size() || k < b.size();) {
    const bool is_first = k == b.size() || (i < a.size() && a[i].low <= b[k].low);
    const HeightRange next = is_first ? a[i++] : b[k++];
    // The part below the last range's end is there already.
    append_range(out, out.empty() ? next.low : std::max(next.low, out.back().high), next.high);
  }
  return out;
}

HeightRanges common_of(const HeightRanges& a, const HeightRanges& b) {
  HeightRanges out;
  for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
    append_range(out, std::max(a[i].low, b[k].low), std::min(a[i].high, b[k].high));
    if (a[i].high < b[k].high) {
      ++i;
    } else {
      ++k;
    }
  }
  return out;
}

HeightRanges without(const HeightRanges& a, const HeightRanges& b) {
  HeightRanges out;
  std::size_t k = 0;
  for (const HeightRange& range : a) {
    std::int32_t low = range.low;
    while (k < b.size() && b[k].high <= low) ++k;
    for (std::size_t i = k; i < b.size() && b[i].low < range.high; ++i) {
      append_range(out, low, b[i].low);
      low = b[i].high;
    }
    append_range(out, low, range.high);
  }
  return out;
}

}  // namespace runstone
