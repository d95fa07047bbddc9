#include "common/runs/reorder.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "common/runs/layer_walk.hpp"
#include "common/runs/line_starts.hpp"
#include "common/runs/lookback.hpp"

namespace runstone {
namespace {

RunList reordered(const RunChunk& chunk, AxisOrder order) {
  LineStarts lines;
  lines.read(chunk, order);
  const std::span<const LineStart> starts = lines.all();
  std::size_t count = 1;
  for (std::size_t i = 1; i < starts.size(); ++i)
    count += starts[i].material != starts[i - 1].material;
  const std::uint32_t volume = chunk.volume();
  RunList out(volume);
  // The count is exact: chunks are made once and kept long.
  out.reserve(count);
  const std::uint32_t side = ordered(chunk.extent, order).f;
  Material open = starts[0].material;
  for (std::uint32_t line = 0; line < volume / side; ++line) {
    for (const LineStart& start : lines.line(line)) {
      if (start.material == open) continue;
      out.push_back({line * side + start.at, open});
      open = start.material;
    }
  }
  out.push_back({volume, open});
  return out;
}

/// The numbers of places where two lines that are consecutive in an order meet with different
/// materials.
struct Seams {
  // For the orders in which the faster of the other two axes is the middle one, and for the other
  // orders.
  std::uint32_t faster_next = 0;
  std::uint32_t slower_next = 0;
};

/// Keeps the layer where the lines of `rank` begin, and walks the layer where they end.
template <class Runs>
Seams seams(Runs runs, OrderedExtent e, int rank, std::span<Material> begins) {
  const std::uint32_t n = rank == 0 ? e.m : e.f;  // along the faster of the other axes
  const std::uint32_t k = rank == 2 ? e.m : e.s;  // along the slower one
  const std::uint32_t side = rank == 0 ? e.f : rank == 1 ? e.m : e.s;
  walk_layer(runs, e, rank, 0,
             [&](std::uint32_t slow, std::uint32_t a, std::uint32_t b, Material material) {
               std::fill(begins.begin() + slow * n + a, begins.begin() + slow * n + b, material);
             });
  Seams out;
  walk_layer(runs, e, rank, side - 1,
             [&](std::uint32_t slow, std::uint32_t a, std::uint32_t b, Material ending) {
               // Line (slow, v) is followed by (slow, v + 1), or at the end of the row by (slow +
               // 1, 0): by the next slot.
               const std::uint32_t row = slow * n;
               const std::uint32_t stop = std::min(row + b + 1, n * k);
               for (std::uint32_t i = row + a + 1; i < stop; ++i)
                 out.faster_next += begins[i] != ending;
               // The other order continues at (slow + 1, v), or from the last row at (0, v + 1).
               if (slow + 1 < k) {
                 for (std::uint32_t v = a; v < b; ++v)
                   out.slower_next += begins[row + n + v] != ending;
               } else {
                 for (std::uint32_t v = a; v < b && v + 1 < n; ++v)
                   out.slower_next += begins[v + 1] != ending;
               }
             });
  return out;
}

/// Returns the number of pairs of neighbours along the axis of `rank` that differ.
template <class Runs>
std::uint32_t differences(Runs runs, OrderedExtent e, int rank) {
  std::uint32_t sum = 0;
  if (rank == 0) {
    for (std::size_t i = 0; i + 1 < runs.size(); ++i) sum += runs.end(i) % e.f != 0;
    return sum;
  }
  const std::uint32_t behind = rank == 1 ? e.f : e.layer();
  const std::uint32_t block = rank == 1 ? e.layer() : e.volume();
  Lookback<Runs> lookback(runs, behind);
  for (std::uint32_t base = 0; base < e.volume(); base += block) {
    lookback.compare(base + behind, base + block,
                     [&](std::uint32_t i, std::uint32_t j, Material) { sum += j - i; });
  }
  return sum;
}

}  // namespace

RunChunk reorder(const RunChunk& chunk, AxisOrder order) {
  if (order == chunk.order) return chunk;
  if (chunk.is_uniform()) return uniform_chunk(chunk.extent, chunk.runs.material(0), order);
  return {chunk.extent, order, reordered(chunk, order)};
}

std::array<std::uint32_t, kAxisOrderCount> runs_per_order(const RunChunk& chunk) {
  std::array<std::uint32_t, kAxisOrderCount> out;
  out.fill(1);
  if (chunk.is_uniform()) return out;
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  std::vector<Material> begins(std::max({e.layer(), e.f * e.s, e.m * e.s}));
  chunk.runs.visit([&](const auto& runs) {
    for (int rank = 0; rank < 3; ++rank) {
      const std::uint32_t inside = differences(runs, e, rank);
      const Seams between = seams(runs, e, rank, begins);
      const int faster = rank == 0 ? 1 : 0;
      for (const AxisOrder order : kAxisOrders) {
        const auto axes = axes_of(order);
        if (rank_of(axes[0], chunk.order) != rank) continue;
        const bool faster_next = rank_of(axes[1], chunk.order) == faster;
        out[static_cast<std::size_t>(order)] +=
            inside + (faster_next ? between.faster_next : between.slower_next);
      }
    }
  });
  return out;
}

AxisOrder cheapest_order(const RunChunk& chunk) {
  const auto runs = runs_per_order(chunk);
  return kAxisOrders[static_cast<std::size_t>(std::min_element(runs.begin(), runs.end()) -
                                              runs.begin())];
}

RunChunk in_cheapest_order(RunChunk chunk) {
  const AxisOrder order = cheapest_order(chunk);
  return order == chunk.order ? std::move(chunk) : reorder(chunk, order);
}

}  // namespace runstone
