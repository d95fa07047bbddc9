#include "common/runs/reorder.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "common/runs/layer.hpp"
#include "common/runs/layer_walk.hpp"

namespace runstone {
namespace {

/// Two cursors over the same runs, which compare each voxel with the voxel `behind` places before
/// it.
template <class Runs>
class Lookback {
 public:
  Lookback(Runs runs, std::uint32_t behind) : lead_(runs), lag_(runs), behind_(behind) {}

  /// Calls differs(i, j, material) for the stretches [i, j) of [from, to) whose material differs
  /// from the material `behind` places earlier. Requires behind <= from, and calls in ascending
  /// order.
  template <class F>
  void compare(std::uint32_t from, std::uint32_t to, F&& differs) {
    if (from >= to) return;
    lead_.seek(from);
    lag_.seek(from - behind_);
    for (std::uint32_t i = from;;) {
      const std::uint32_t lead_end = lead_.end();
      const std::uint32_t lag_end = lag_.end() + behind_;
      const std::uint32_t stop = std::min({lead_end, lag_end, to});
      if (lead_.material() != lag_.material()) differs(i, stop, lead_.material());
      if (stop == to) return;
      i = stop;
      if (lead_end == stop) lead_.next();
      if (lag_end == stop) lag_.next();
    }
  }

 private:
  RunCursor<Runs> lead_, lag_;
  std::uint32_t behind_;
};

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

/// Start of a run inside a line of the new order.
struct LineStart {
  std::uint16_t at;
  Material material;
};

template <class Runs>
RunList reordered(Runs runs, OrderedExtent e, std::array<int, 3> ranks, std::uint32_t volume) {
  const std::array<std::uint32_t, 3> sides = {e.f, e.m, e.s};
  const auto rank = [&](int i) {
    return static_cast<std::size_t>(ranks[static_cast<std::size_t>(i)]);
  };
  const std::uint32_t side = sides[rank(0)];
  const std::uint32_t lines = volume / side;
  // Step in line numbers of the new order, by old rank.
  std::array<std::uint32_t, 3> step{};
  step[rank(1)] = 1;
  step[rank(2)] = sides[rank(1)];

  // A counting sort of the starts by new line. The starts of each line arrive in ascending order,
  // so two sweeps suffice.
  std::vector<std::uint32_t> place(lines + 1, 0);
  for_each_start(runs, e, ranks[0],
                 [&](std::uint32_t line, std::uint32_t f0, std::uint32_t f1, Material) {
                   std::uint32_t at = line % e.m * step[1] + line / e.m * step[2] + f0 * step[0];
                   for (std::uint32_t f = f0; f < f1; ++f, at += step[0]) ++place[at];
                 });
  std::exclusive_scan(place.begin(), place.end(), place.begin(), 0U);
  std::vector<LineStart> starts(place.back());
  for_each_start(runs, e, ranks[0],
                 [&](std::uint32_t line, std::uint32_t f0, std::uint32_t f1, Material material) {
                   const std::uint32_t m = line % e.m;
                   const std::uint32_t s = line / e.m;
                   const std::array<std::uint32_t, 3> coords = {f0, m, s};
                   const auto start =
                       LineStart{static_cast<std::uint16_t>(coords[rank(0)]), material};
                   std::uint32_t at = m * step[1] + s * step[2] + f0 * step[0];
                   for (std::uint32_t f = f0; f < f1; ++f, at += step[0])
                     starts[place[at]++] = start;
                 });

  std::size_t count = 1;
  for (std::size_t i = 1; i < starts.size(); ++i)
    count += starts[i].material != starts[i - 1].material;
  RunList out(volume);
  // The count is exact: chunks are made once and kept long.
  out.reserve(count);
  Material open = starts[0].material;
  std::size_t i = 0;
  for (std::uint32_t line = 0; line < lines; ++line) {
    // After the sort, place[line] is the end of its line.
    for (; i < place[line]; ++i) {
      if (starts[i].material == open) continue;
      out.push_back({line * side + starts[i].at, open});
      open = starts[i].material;
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
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  const auto axes = axes_of(order);
  const std::array<int, 3> ranks = {rank_of(axes[0], chunk.order), rank_of(axes[1], chunk.order),
                                    rank_of(axes[2], chunk.order)};
  return chunk.runs.visit([&](const auto& runs) {
    return RunChunk{chunk.extent, order, reordered(runs, e, ranks, chunk.volume())};
  });
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
