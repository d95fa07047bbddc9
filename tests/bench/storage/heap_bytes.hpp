// What a block on the heap takes, as glibc's malloc hands it out on machines of 64 bits: eight bytes before it,
// steps of 16, at least 32. Blocks that get pages of their own (from 128 KiB on at first) take up to a page
// more, which is left out.
#pragma once
#include <algorithm>
#include <cstddef>

namespace runstone::bench::storage {

/// Of a block that was asked for with `bytes`; 0 for none.
constexpr std::size_t heap_bytes(std::size_t bytes) {
  if (bytes == 0) return 0;
  return std::max<std::size_t>((bytes + 8 + 15) / 16 * 16, 32);
}

}  // namespace runstone::bench::storage
