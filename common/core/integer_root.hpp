// Integer square root: the same result on every platform.
#pragma once
#include <cmath>
#include <cstdint>

namespace runstone {

/// Returns the largest r with r * r <= value. Requires 0 <= value < 2^62. The processor's square
/// root, which IEEE 754 defines to the last bit, is off by at most one in this range; the result is
/// checked in integers.
inline std::int64_t integer_root(std::int64_t value) {
  auto root = static_cast<std::int64_t>(std::sqrt(static_cast<double>(value)));
  root -= root * root > value ? 1 : 0;
  root += (root + 1) * (root + 1) <= value ? 1 : 0;
  return root;
}

}  // namespace runstone
