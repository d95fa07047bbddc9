#include "common/edits/descriptor/placed_clipboard.hpp"

#include <algorithm>
#include <array>

#include "common/runs/cut.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_cursor.hpp"
#include "common/runs/span_boxes.hpp"

namespace runstone {
namespace {

using Ints3 = std::array<std::int32_t, 3>;

Ints3 of_position(VoxelPos p) { return {p.x, p.y, p.z}; }

constexpr std::array<Axis, 3> kAxes = {Axis::x, Axis::y, Axis::z};

LocalPos local(const Ints3& c) {
  return {static_cast<std::uint8_t>(c[0]), static_cast<std::uint8_t>(c[1]),
          static_cast<std::uint8_t>(c[2])};
}

/// Returns the cells that lie in a box of the world. Requires a non-empty box inside the paste's
/// box.
CellBox cells_in(const Paste& paste, const VoxelBox& box) {
  const Ints3 at = of_position(paste.at), min = of_position(box.min), max = of_position(box.max);
  const Extent whole = paste.orientation.rotated(paste.clipboard->extent());
  Ints3 first{}, sides{};
  for (const Axis axis : kAxes) {
    const auto i = static_cast<std::size_t>(axis);
    const auto k = static_cast<std::size_t>(paste.orientation.along(axis));
    sides[k] = max[i] - min[i];
    first[k] = paste.orientation.flipped(axis) ? at[i] + whole.sides()[i] - max[i] : min[i] - at[i];
  }
  const LocalPos extent = local(sides);
  return {local(first), {extent.x, extent.y, extent.z}};
}

/// Returns a byte in which bit k is set if clipboard axis k runs backwards in the world.
std::uint8_t backward_axes(const Orientation& orientation) {
  unsigned bits = 0;
  for (const Axis axis : kAxes) {
    if (orientation.flipped(axis)) bits |= 1U << static_cast<unsigned>(orientation.along(axis));
  }
  return static_cast<std::uint8_t>(bits);
}

/// Returns the axis order of the clipboard that corresponds to `order` of the world.
AxisOrder order_in_clipboard(const Orientation& orientation, AxisOrder order) {
  const auto world = axes_of(order);
  const std::array<Axis, 3> wanted = {orientation.along(world[0]), orientation.along(world[1]),
                                      orientation.along(world[2])};
  return *std::find_if(kAxisOrders.begin(), kAxisOrders.end(),
                       [&](AxisOrder candidate) { return axes_of(candidate) == wanted; });
}

/// Returns the box in the world of cells first .. last (half-open), given by clipboard axis.
VoxelBox in_world(const Paste& paste, const Ints3& first, const Ints3& last) {
  Ints3 min = of_position(paste.at), max = min;
  for (const Axis axis : kAxes) {
    const auto i = static_cast<std::size_t>(axis);
    const auto k = static_cast<std::size_t>(paste.orientation.along(axis));
    const std::int32_t side = paste.clipboard->extent().sides()[k];
    const bool flipped = paste.orientation.flipped(axis);
    min[i] += flipped ? side - last[k] : first[k];
    max[i] += flipped ? side - first[k] : last[k];
  }
  return {{min[0], min[1], min[2]}, {max[0], max[1], max[2]}};
}

VoxelBox in_world(const Paste& paste, const OrderedBox& cells) {
  const auto axes = axes_of(paste.clipboard->cells().order);
  Ints3 first{}, last{};
  for (std::size_t rank = 0; rank < 3; ++rank) {
    first[static_cast<std::size_t>(axes[rank])] = static_cast<std::int32_t>(cells.first[rank]);
    last[static_cast<std::size_t>(axes[rank])] = static_cast<std::int32_t>(cells.last[rank]);
  }
  return in_world(paste, first, last);
}

}  // namespace

VoxelBox box_of(const Paste& paste) {
  const auto& [first, extent] = paste.clipboard->touched_box();
  return in_world(paste, {first.x, first.y, first.z},
                  {first.x + extent.x, first.y + extent.y, first.z + extent.z});
}

bool touches(const Paste& paste, const VoxelBox& box) {
  const VoxelBox inside = intersect(box_of(paste), box);
  if (inside.empty()) return false;
  const CellBox part = cells_in(paste, inside);
  const RunChunk& cells = paste.clipboard->cells();
  const OrderedExtent e = ordered(cells.extent, cells.order);
  const OrderedPos from = to_ordered(part.first, cells.order);
  const OrderedExtent sides = ordered(part.extent, cells.order);
  return cells.runs.visit([&]<class Runs>(const Runs& runs) {
    RunCursor<Runs> cursor(runs);
    for (std::uint32_t s = from.s; s < from.s + sides.s; ++s) {
      for (std::uint32_t m = from.m; m < from.m + sides.m; ++m) {
        const VoxelIndex begin = from.f + e.f * (m + e.m * s);
        cursor.seek(begin);
        // Neighbouring runs differ, so the run behind an untouched run is touched.
        if (cursor.material() != 0 || cursor.end() < begin + sides.f) return true;
      }
    }
    return false;
  });
}

std::vector<ChunkCoord> touched_chunks(const Paste& paste, std::int32_t edge) {
  const auto last_chunk = [edge](const VoxelBox& box) {
    return chunk_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, edge);
  };
  const VoxelBox whole = box_of(paste);
  const ChunkCoord low = chunk_of(whole.min, edge), high = last_chunk(whole);
  const auto side = [](std::int32_t from, std::int32_t to) {
    return static_cast<std::size_t>(to - from + 1);
  };
  const std::size_t y_side = side(low.y, high.y), z_side = side(low.z, high.z);
  // At least one cell is touched, so a box within one chunk touches it. A box of which every cell is
  // touched touches all of its chunks. This covers most pastes, and saves the walk over their runs.
  const bool all_touched =
      low == high || paste.clipboard->touched() == paste.clipboard->touched_box().extent.volume();
  std::vector<bool> marked(side(low.x, high.x) * y_side * z_side, all_touched);
  const auto place = [&](ChunkCoord c) {
    return (side(low.x, c.x) - 1) * y_side * z_side + (side(low.y, c.y) - 1) * z_side +
           side(low.z, c.z) - 1;
  };
  const auto mark = [&](const VoxelBox& box) {
    const ChunkCoord first = chunk_of(box.min, edge), last = last_chunk(box);
    for (ChunkCoord c = first; c.x <= last.x; ++c.x) {
      for (c.y = first.y; c.y <= last.y; ++c.y) {
        for (c.z = first.z; c.z <= last.z; ++c.z) marked[place(c)] = true;
      }
    }
  };
  const RunChunk& cells = paste.clipboard->cells();
  const OrderedExtent e = ordered(cells.extent, cells.order);
  const auto mark_runs = [&](const auto& runs) {
    std::uint32_t begin = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (runs.material(i) != 0) {
        for_each_box(e, begin, runs.end(i),
                     [&](const OrderedBox& box) { mark(in_world(paste, box)); });
      }
      begin = runs.end(i);
    }
  };
  if (!all_touched) cells.runs.visit(mark_runs);
  std::vector<ChunkCoord> out;
  for (ChunkCoord c = low; c.x <= high.x; ++c.x) {
    for (c.y = low.y; c.y <= high.y; ++c.y) {
      for (c.z = low.z; c.z <= high.z; ++c.z) {
        if (marked[place(c)]) out.push_back(c);
      }
    }
  }
  return out;
}

std::optional<PlacedCells> placed_cells(const Paste& paste, const VoxelBox& box, AxisOrder order) {
  const VoxelBox inside = intersect(box_of(paste), box);
  if (inside.empty()) return std::nullopt;
  const CellBox part = cells_in(paste, inside);
  RunChunk cells =
      cut(paste.clipboard->cells(), part.first, part.extent, backward_axes(paste.orientation));
  cells = reorder(cells, order_in_clipboard(paste.orientation, order));
  // The runs do not change; the axes get the names that they have in the world.
  cells.extent = paste.orientation.rotated(cells.extent);
  cells.order = order;
  return PlacedCells{inside, std::move(cells)};
}

}  // namespace runstone
