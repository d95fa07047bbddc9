#include "common/runs/column_tops.hpp"

#include <algorithm>
#include <array>

#include "common/core/assert.hpp"
#include "common/runs/bit_row.hpp"
#include "common/runs/span_boxes.hpp"

namespace runstone {
namespace {

/// The place of a column in the tops, by its coordinates in the chunk's own axis order.
struct ColumnPlaces {
  std::uint32_t extent_x;
  Axis first;  // the axis of the first coordinate: x or z
  std::size_t of(std::uint32_t first_at, std::uint32_t second_at) const {
    return first == Axis::x ? first_at + extent_x * second_at : second_at + extent_x * first_at;
  }
};

bool shows(const ShowingMaterials& showing, Material id) {
  return id >= showing.size() || showing[id];
}

/// Lines along y: a line is a column. The last run of a line that shows is its top, so later runs
/// replace earlier ones.
template <class Runs>
std::size_t find_in_lines(const Runs& runs, OrderedExtent e, const ColumnPlaces& places,
                          std::int32_t base_y, const ShowingMaterials& showing,
                          std::span<ColumnTop> tops) {
  std::size_t found = 0;
  std::uint32_t first = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::uint32_t last = runs.end(i);
    if (shows(showing, runs.material(i))) {
      for (std::uint32_t line = first / e.f; line * e.f < last; ++line) {
        ColumnTop& top = tops[places.of(line % e.m, line / e.m)];
        const std::uint32_t highest = std::min(last, (line + 1) * e.f) - 1 - line * e.f;
        // Tops at or above the upper end of the chunk are those of chunks above.
        if (top.is_found() && top.y >= base_y + static_cast<std::int32_t>(e.f)) continue;
        found += top.is_found() ? 0 : 1;
        top = {base_y + static_cast<std::int32_t>(highest), runs.material(i)};
      }
    }
    first = last;
  }
  return found;
}

/// Lines along x or z. The runs are visited from the last to the first, so that the voxels of each
/// column come from above. A row of bits has the open columns of one line.
template <class Row, class Runs>
std::size_t find_in_rows(const Runs& runs, OrderedExtent e, bool is_y_slowest,
                         const ColumnPlaces& places, std::int32_t base_y,
                         const ShowingMaterials& showing, std::span<ColumnTop> tops) {
  const std::size_t y_axis = is_y_slowest ? 2 : 1, row_axis = is_y_slowest ? 1 : 2;
  const std::uint32_t row_count = is_y_slowest ? e.m : e.s;
  std::array<Row, kSideMax> open{};
  std::size_t open_count = 0;
  for (std::uint32_t row = 0; row < row_count; ++row) {
    for (std::uint32_t f = 0; f < e.f; ++f) {
      if (!tops[places.of(f, row)].is_found()) open[row] |= Row{1} << f;
    }
    open_count += bit_count(open[row]);
  }
  const std::size_t open_before = open_count;
  const auto close = [&](const OrderedBox& box, Material material) {
    const std::int32_t y = base_y + static_cast<std::int32_t>(box.last[y_axis] - 1);
    const Row line = bits_below<Row>(box.last[0]) & ~bits_below<Row>(box.first[0]);
    for (std::uint32_t row = box.first[row_axis]; row < box.last[row_axis]; ++row) {
      Row bits = open[row] & line;
      open[row] &= ~bits;
      open_count -= bit_count(bits);
      for (; bits != 0; bits &= bits - 1) tops[places.of(lowest_bit(bits), row)] = {y, material};
    }
  };
  std::array<OrderedBox, 5> boxes;
  for (std::size_t i = runs.size(); i-- > 0 && open_count != 0;) {
    if (!shows(showing, runs.material(i))) continue;
    std::size_t count = 0;
    for_each_box(e, i == 0 ? 0 : runs.end(i - 1), runs.end(i),
                 [&](const OrderedBox& box) { boxes[count++] = box; });
    while (count-- > 0) close(boxes[count], runs.material(i));
  }
  return open_before - open_count;
}

}  // namespace

std::size_t find_column_tops(const RunChunk& chunk, std::int32_t base_y,
                             const ShowingMaterials& showing, std::span<ColumnTop> tops) {
  RUNSTONE_ASSERT(tops.size() == std::size_t{chunk.extent.x} * chunk.extent.z);
  if (chunk.is_uniform() && !shows(showing, chunk.runs.material(0))) return 0;
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  const std::array<Axis, 3> axes = axes_of(chunk.order);
  if (axes[0] == Axis::y) {
    const ColumnPlaces places{chunk.extent.x, axes[1]};
    return chunk.runs.visit(
        [&](const auto& runs) { return find_in_lines(runs, e, places, base_y, showing, tops); });
  }
  const ColumnPlaces places{chunk.extent.x, axes[0]};
  const bool is_y_slowest = axes[2] == Axis::y;
  return chunk.runs.visit([&](const auto& runs) {
    return e.f <= kRowBits<Row64>
               ? find_in_rows<Row64>(runs, e, is_y_slowest, places, base_y, showing, tops)
               : find_in_rows<Row128>(runs, e, is_y_slowest, places, base_y, showing, tops);
  });
}

}  // namespace runstone
