#include "common/sculpt/row_stretches.hpp"

#include <algorithm>
#include <cstddef>

namespace runstone {

void join_stretches(std::vector<RowStretch>& row) {
  std::sort(row.begin(), row.end(),
            [](const RowStretch& a, const RowStretch& b) { return a.low < b.low; });
  std::size_t count = 0;
  for (const RowStretch& part : row) {
    if (count > 0 && part.low <= row[count - 1].high) {
      row[count - 1].high = std::max(row[count - 1].high, part.high);
    } else {
      row[count++] = part;
    }
  }
  row.resize(count);
}

void subtract_stretches(const std::vector<RowStretch>& inside, std::vector<RowStretch>& row,
                        std::vector<RowStretch>& left) {
  for (const RowStretch& hole : inside) {
    left.clear();
    for (const RowStretch& part : row) {
      if (part.low < std::min(part.high, hole.low))
        left.push_back({part.low, std::min(part.high, hole.low)});
      if (std::max(part.low, hole.high) < part.high)
        left.push_back({std::max(part.low, hole.high), part.high});
    }
    row.swap(left);
  }
}

std::vector<RowStretch> common_stretches(const std::vector<RowStretch>& a,
                                         const std::vector<RowStretch>& b) {
  std::vector<RowStretch> out;
  for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
    const RowStretch part{std::max(a[i].low, b[k].low), std::min(a[i].high, b[k].high)};
    if (part.low < part.high) out.push_back(part);
    if (a[i].high < b[k].high) {
      ++i;
    } else {
      ++k;
    }
  }
  return out;
}

}  // namespace runstone
