#include "common/mesh/rdm/chunk_borders.hpp"

#include <algorithm>
#include <functional>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/border_rows.hpp"
#include "common/mesh/rdm/side_axes.hpp"
#include "common/runs/layer.hpp"

namespace runstone {

void ChunkBorders::begin(const RunChunk& chunk) {
  extent_ = chunk.extent;
  order_ = chunk.order;
  words_.clear();
  materials_.clear();
}

void ChunkBorders::read(const RunChunk& chunk, const VisibilityTable& visibility) {
  begin(chunk);
  if (chunk.is_uniform()) return;
  const auto sides = chunk.extent.sides();
  const auto longest = *std::max_element(sides.begin(), sides.end());
  if (longest <= 32) {
    read_sides<Row32>(chunk, visibility);
  } else if (longest <= 64) {
    read_sides<Row64>(chunk, visibility);
  } else {
    read_sides<Row128>(chunk, visibility);
  }
}

template <class Row>
void ChunkBorders::read_sides(const RunChunk& chunk, const VisibilityTable& visibility) {
  std::array<std::array<Row, kRowBits<Row>>, 2> planes;
  for (const rdm::SideAxes& axes : rdm::side_axes(chunk.order)) {
    for (const bool positive : {false, true}) {
      const std::uint32_t at = positive ? rdm::side_of(chunk, axes.layer) - 1 : 0;
      rdm::read_layer_rows(chunk, {axes.layer, axes.bit, at}, planes,
                           [of = visibility.data()](Material material) -> rdm::PaletteIndex {
                             static_assert(static_cast<int>(Visibility::opaque) == 1 &&
                                           static_cast<int>(Visibility::transparent) == 2);
                             return static_cast<rdm::PaletteIndex>(of[material]);
                           });
      layer_.clear();
      if (std::any_of(planes[1].begin(), planes[1].end(), [](Row row) { return row != 0; })) {
        layer_.resize(std::size_t{rdm::side_of(chunk, axes.bit)} * rdm::side_of(chunk, axes.row));
        read_layer(chunk, axes.layer, at, axes.bit, layer_);
        std::erase_if(layer_, [&visibility](Material material) {
          return visibility[material] != Visibility::transparent;
        });
      }
      keep_side<std::array<Row, kRowBits<Row>>>(chunk, rdm::direction_of(axes.layer, positive),
                                                axes.bit, axes.row, {planes[0], planes[1], layer_});
    }
  }
}

template <class Rows>
void ChunkBorders::keep(const RunChunk& chunk,
                        const std::array<SideRows<Rows>, kDirectionCount>& sides) {
  begin(chunk);
  const auto axes = rdm::side_axes(chunk.order);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const rdm::SideAxes& a = axes[i / 2];
    keep_side(chunk, rdm::direction_of(a.layer, i % 2 != 0), a.bit, a.row, sides[i]);
  }
}
template void ChunkBorders::keep(
    const RunChunk&, const std::array<SideRows<std::array<Row32, 32>>, kDirectionCount>&);
template void ChunkBorders::keep(
    const RunChunk&, const std::array<SideRows<std::array<Row64, 64>>, kDirectionCount>&);
template void ChunkBorders::keep(
    const RunChunk&, const std::array<SideRows<std::array<Row128, 128>>, kDirectionCount>&);

template <class Rows>
void ChunkBorders::keep_side(const RunChunk& chunk, Direction direction, Axis bit_axis,
                             Axis row_axis, const SideRows<Rows>& rows) {
  Side& side = sides_[static_cast<std::size_t>(direction)];
  side.bit_axis = bit_axis;
  side.row_words = static_cast<std::uint8_t>((rdm::side_of(chunk, bit_axis) + 31) / 32);
  side.row_count = static_cast<std::uint8_t>(rdm::side_of(chunk, row_axis));
  side.first = static_cast<std::uint16_t>(words_.size());
  RUNSTONE_ASSERT(side.row_count <= rows.opaque.size() &&
                  side.row_words * 32u <= sizeof(rows.opaque[0]) * 8);
  const auto append = [this, &side](const Rows& from) {
    std::size_t to = words_.size();
    words_.resize(to + std::size_t{side.row_words} * side.row_count);
    for (std::size_t r = 0; r < side.row_count; ++r) {
      auto row = from[r];
      for (unsigned w = 0; w < side.row_words; ++w) {
        words_[to++] = static_cast<std::uint32_t>(row);
        if constexpr (sizeof(row) > sizeof(std::uint32_t)) row >>= 32;
      }
    }
  };
  append(rows.opaque);
  side.first_material = static_cast<std::uint32_t>(materials_.size());
  side.materials = 0;
  if (rows.materials.empty()) return;
  append(rows.transparent);
  const bool is_single = std::adjacent_find(rows.materials.begin(), rows.materials.end(),
                                            std::not_equal_to<>()) == rows.materials.end();
  const auto kept = rows.materials.first(is_single ? 1 : rows.materials.size());
  materials_.insert(materials_.end(), kept.begin(), kept.end());
  side.materials = static_cast<std::uint16_t>(kept.size());
}

}  // namespace runstone
