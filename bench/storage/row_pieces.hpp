// Runs cut at the ends of lines, for stores that flatten a chunk in another way than the runs do.
#pragma once
#include <algorithm>
#include <cstdint>

#include "common/runs/axis_order.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::bench::storage {

/// Calls piece(first, count, material) for pieces that tile the chunk in index order, each inside a
/// line of the fastest axis. Cost: O(runs + lines).
template <class F>
void for_each_row_piece(const RunChunk& chunk, F&& piece) {
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  chunk.runs.visit([&](const auto& runs) {
    OrderedPos at{0, 0, 0};
    std::uint32_t begin = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      while (begin < runs.end(i)) {
        const std::uint32_t count = std::min(runs.end(i) - begin, e.f - at.f);
        piece(at, count, runs.material(i));
        begin += count;
        at.f += count;
        if (at.f < e.f) continue;
        at.f = 0;
        if (++at.m < e.m) continue;
        at.m = 0;
        ++at.s;
      }
    }
  });
}

}  // namespace runstone::bench::storage
