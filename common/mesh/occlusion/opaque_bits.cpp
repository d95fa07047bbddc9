#include "common/mesh/occlusion/opaque_bits.hpp"

#include <algorithm>
#include <array>

#include "common/mesh/rdm/border_rows.hpp"
#include "common/runs/bit_row.hpp"

namespace runstone {
namespace {

constexpr std::uint32_t kWordBits = 64;

}  // namespace

void OpaqueBits::set_range(std::uint32_t place, std::uint32_t count) {
  std::uint64_t* word = &words_[place / kWordBits];
  const std::uint32_t first = place % kWordBits;
  if (first + count <= kWordBits) {
    *word |= bits_below<Row64>(count) << first;
    return;
  }
  *word++ |= ~std::uint64_t{0} << first;
  count -= kWordBits - first;
  for (; count >= kWordBits; count -= kWordBits) *word++ = ~std::uint64_t{0};
  *word |= bits_below<Row64>(count);
}

void OpaqueBits::read(const RunChunk& chunk, const ChunksAround& around,
                      const VisibilityTable& visibility) {
  axes_ = axes_of(chunk.order);
  for (std::size_t axis = 0; axis < 3; ++axis) sides_[axis] = chunk.extent.sides()[axis];
  const auto padded = [this](Axis axis) {
    return static_cast<std::uint32_t>(sides_[static_cast<std::size_t>(axis)]) + 2;
  };
  const std::uint32_t row = (padded(axes_[0]) + kWordBits - 1) / kWordBits * kWordBits;
  steps_[static_cast<std::size_t>(axes_[0])] = 1;
  steps_[static_cast<std::size_t>(axes_[1])] = row;
  steps_[static_cast<std::size_t>(axes_[2])] = row * padded(axes_[1]);
  words_.assign(std::size_t{row} * padded(axes_[1]) * padded(axes_[2]) / kWordBits, 0);
  read_inside(chunk, visibility);
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        const RunChunk* const beyond = around[around_place(x, y, z)];
        if (beyond != nullptr && (x != 0 || y != 0 || z != 0))
          read_beyond(*beyond, {x, y, z}, visibility);
      }
    }
  }
}

void OpaqueBits::read_inside(const RunChunk& chunk, const VisibilityTable& visibility) {
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  const std::uint32_t row = steps_[static_cast<std::size_t>(axes_[1])];
  const std::uint32_t gap = steps_[static_cast<std::size_t>(axes_[2])] - row * e.m;
  chunk.runs.visit([&](const auto& runs) {
    // These variables describe the line of the voxel `begin`: its first bit, its first voxel and
    // its number in its layer.
    std::uint32_t line_bit = place(0, 0, 0), line_begin = 0, line = 0;
    const auto next_line = [&] {
      line_begin += e.f;
      line_bit += row;
      if (++line < e.m) return;
      line = 0;
      line_bit += gap;
    };
    const auto is_opaque = [&](std::size_t i) {
      return visibility[runs.material(i)] == Visibility::opaque;
    };
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (!is_opaque(i)) continue;
      std::uint32_t begin = i == 0 ? 0 : runs.end(i - 1);
      while (i + 1 < runs.size() && is_opaque(i + 1)) ++i;
      const std::uint32_t end = runs.end(i);
      while (begin - line_begin >= e.f) next_line();
      while (end - line_begin > e.f) {
        set_range(line_bit + begin - line_begin, line_begin + e.f - begin);
        next_line();
        begin = line_begin;
      }
      set_range(line_bit + begin - line_begin, end - begin);
    }
  });
}

void OpaqueBits::read_beyond(const RunChunk& beyond, const Place3& offset,
                             const VisibilityTable& visibility) {
  std::size_t across = 0, across_count = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (offset[axis] == 0) continue;
    across = axis;
    ++across_count;
  }
  if (beyond.is_uniform() && visibility[beyond.runs.material(0)] != Visibility::opaque) return;
  if (across_count == 1) {
    if (*std::max_element(sides_.begin(), sides_.end()) <= 64)
      return read_side<Row64>(beyond, offset, across, visibility);
    return read_side<Row128>(beyond, offset, across, visibility);
  }
  // The box is an edge or a corner, so it has more than one voxel along at most one axis.
  Place3 at{}, from{}, move{};
  int count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (offset[axis] == 0) {
      move[axis] = 1;
      count = sides_[axis];
    } else {
      at[axis] = offset[axis] < 0 ? -1 : sides_[axis];
      from[axis] = offset[axis] < 0 ? beyond.extent.sides()[axis] - 1 : 0;
    }
  }
  for (int i = 0; i < count; ++i) {
    const auto along = [&](std::size_t axis) {
      return static_cast<std::uint8_t>(from[axis] + i * move[axis]);
    };
    if (visibility[material_at(beyond, {along(0), along(1), along(2)})] == Visibility::opaque)
      set(place(at[0] + i * move[0], at[1] + i * move[1], at[2] + i * move[2]));
  }
}

void OpaqueBits::set_row(std::uint32_t place, std::uint32_t step, std::uint64_t row) {
  if (row == 0) return;
  if (step != 1) {
    for (; row != 0; row &= row - 1) set(place + lowest_bit(Row64{row}) * step);
    return;
  }
  const std::uint32_t first = place % kWordBits;
  words_[place / kWordBits] |= row << first;
  if (first != 0 && row >> (kWordBits - first) != 0)
    words_[place / kWordBits + 1] |= row >> (kWordBits - first);
}

template <class Row>
void OpaqueBits::read_side(const RunChunk& beyond, const Place3& offset, std::size_t axis,
                           const VisibilityTable& visibility) {
  // u lies along the fastest axis of the chunk if it can, so that its bits are neighbours.
  const Axis u_axis = axes_[static_cast<std::size_t>(axes_[0]) == axis ? 1 : 0];
  const Axis v_axis = axes_[static_cast<std::size_t>(axes_[2]) == axis ? 1 : 2];
  const std::uint32_t layer = offset[axis] < 0 ? beyond.extent.sides()[axis] - 1U : 0U;
  std::array<std::array<Row, kRowBits<Row>>, 1> planes;
  rdm::read_layer_rows(beyond, {static_cast<Axis>(axis), u_axis, layer}, planes,
                       [&](Material material) -> rdm::PaletteIndex {
                         return visibility[material] == Visibility::opaque ? 1 : 0;
                       });
  Place3 at{};
  at[axis] = offset[axis] < 0 ? -1 : sides_[axis];
  std::uint32_t line = place(at[0], at[1], at[2]);
  const std::uint32_t u_step = step(u_axis);
  for (int v = 0; v < sides_[static_cast<std::size_t>(v_axis)]; ++v, line += step(v_axis)) {
    const Row row = planes[0][static_cast<std::size_t>(v)];
    set_row(line, u_step, static_cast<Row64>(row));
    if constexpr (sizeof(Row) > sizeof(Row64))
      set_row(line + kWordBits * u_step, u_step, static_cast<Row64>(row >> kWordBits));
  }
}

}  // namespace runstone
