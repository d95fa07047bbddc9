// RowRange: adjacent rows of a side of a chunk. Internal to rdm.
#pragma once
#include <cstdint>

namespace runstone::rdm {

struct RowRange {
  std::uint32_t first = 0, end = 0;
  constexpr std::uint32_t count() const { return end - first; }
};

}  // namespace runstone::rdm
