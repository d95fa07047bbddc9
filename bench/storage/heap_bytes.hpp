// The size of a heap block, as glibc's malloc allocates it on 64-bit machines: eight bytes before
// it, steps of 16, at least 32. A block with pages of its own (from 128 KiB on at first) takes up
// to a page more, which is not counted.
#pragma once
#include <algorithm>
#include <cstddef>

namespace runstone::bench::storage {

/// Returns the size of a block for a request of `bytes`, or 0 for no request.
constexpr std::size_t heap_bytes(std::size_t bytes) {
  if (bytes == 0) return 0;
  return std::max<std::size_t>((bytes + 8 + 15) / 16 * 16, 32);
}

}  // namespace runstone::bench::storage
