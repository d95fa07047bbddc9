#include "common/runs/line_starts.hpp"

#include <algorithm>
#include <array>

#include "common/runs/layer_walk.hpp"
#include "common/runs/lookback.hpp"

namespace runstone {
namespace {

/// Calls start(line, f0, f1, material) for all voxels without a predecessor along the axis of
/// `rank`, or with a predecessor of another material. They come as stretches [f0, f1) of line
/// `line` (= m + s * e.m), in index order. So the starts on one line of the axis of `rank` ascend.
template <class Runs, class F>
void for_each_start(Runs runs, OrderedExtent e, int rank, F&& start) {
  if (rank == 0) {
    std::uint32_t begin = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const std::uint32_t end = runs.end(i);
      for (std::uint32_t line = begin / e.f; line * e.f < end; ++line) {
        const std::uint32_t f = std::max(begin, line * e.f) - line * e.f;
        start(line, f, f + 1, runs.material(i));
      }
      begin = end;
    }
    return;
  }
  const auto by_line = [&](std::uint32_t i, std::uint32_t j, Material material) {
    for (std::uint32_t line = i / e.f; i < j; ++line) {
      const std::uint32_t base = line * e.f;
      const std::uint32_t stop = std::min(j, base + e.f);
      start(line, i - base, stop - base, material);
      i = stop;
    }
  };
  const std::uint32_t behind = rank == 1 ? e.f : e.layer();
  // Predecessors never cross a block.
  const std::uint32_t block = rank == 1 ? e.layer() : e.volume();
  RunCursor<Runs> first(runs);
  Lookback<Runs> rest(runs, behind);
  for (std::uint32_t base = 0; base < e.volume(); base += block) {
    first.seek(base);
    for (std::uint32_t i = base; i < base + behind;) {
      if (first.end() == i) first.next();
      const std::uint32_t stop = std::min(first.end(), base + behind);
      by_line(i, stop, first.material());
      i = stop;
    }
    rest.compare(base + behind, base + block, by_line);
  }
}

}  // namespace

void LineStarts::read(const RunChunk& chunk, AxisOrder order) {
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  const OrderedExtent to = ordered(chunk.extent, order);
  const auto axes = axes_of(order);
  const int rank = rank_of(axes[0], chunk.order);
  // Step in line numbers of `order`, by rank in the chunk's order.
  std::array<std::uint32_t, 3> step{};
  step[static_cast<std::size_t>(rank_of(axes[1], chunk.order))] = 1;
  step[static_cast<std::size_t>(rank_of(axes[2], chunk.order))] = to.m;

  // A counting sort by line. The starts of each line arrive in ascending order.
  ends_.assign(to.m * to.s, 0);
  std::uint32_t* const counts = ends_.data();
  std::size_t found = 0;
  chunk.runs.visit([&](const auto& runs) {
    for_each_start(runs, e, rank,
                   [&](std::uint32_t line, std::uint32_t f0, std::uint32_t f1, Material material) {
                     const std::uint32_t m = line % e.m, s = line / e.m;
                     const std::uint32_t along = rank == 0 ? f0 : rank == 1 ? m : s;
                     const LineStart start{static_cast<std::uint16_t>(along), material};
                     std::uint32_t at = m * step[1] + s * step[2] + f0 * step[0];
                     if (unsorted_.size() < found + (f1 - f0)) unsorted_.resize(2 * found + e.f);
                     Unsorted* out = unsorted_.data() + found;
                     found += f1 - f0;
                     for (std::uint32_t f = f0; f < f1; ++f, at += step[0]) {
                       ++counts[at];
                       *out++ = {at, start};
                     }
                   });
  });
  std::uint32_t sum = 0;
  for (std::uint32_t& end : ends_) {
    const std::uint32_t count = end;
    end = sum;  // the begin, until the starts are in place
    sum += count;
  }
  starts_.resize(found);
  for (std::size_t i = 0; i < found; ++i) starts_[counts[unsorted_[i].line]++] = unsorted_[i].start;
}

}  // namespace runstone
