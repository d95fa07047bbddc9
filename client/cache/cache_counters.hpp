// CacheCounters: what a chunk cache has found and kept since it was opened.
#pragma once
#include <cstdint>

namespace runstone {

struct CacheCounters {
  std::uint64_t hits = 0, misses = 0;
  std::uint64_t corrupt = 0;     // rows that failed a check
  std::uint64_t kept = 0;        // chunks written
  std::uint64_t evicted = 0;     // chunks dropped for the size bound
  std::uint64_t not_common = 0;  // chunks dropped because they are outside the common history
  std::uint64_t databases_set_aside = 0;
};

}  // namespace runstone
