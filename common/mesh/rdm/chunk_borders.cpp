#include "common/mesh/rdm/chunk_borders.hpp"

#include <algorithm>
#include <functional>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/border_rows.hpp"
#include "common/mesh/rdm/side_axes.hpp"

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
      const rdm::LayerPlace place{axes.layer, axes.bit, at};
      rdm::read_layer_rows(chunk, place, planes,
                           [of = visibility.data()](Material material) -> rdm::PaletteIndex {
                             static_assert(static_cast<int>(Visibility::opaque) == 1 &&
                                           static_cast<int>(Visibility::transparent) == 2);
                             return static_cast<rdm::PaletteIndex>(of[material]);
                           });
      const auto& transparent = planes[1];
      const bool any =
          std::any_of(transparent.begin(), transparent.end(), [](Row row) { return row != 0; });
      Side& side = begin_side(chunk, rdm::direction_of(axes.layer, positive), axes.bit, axes.row,
                              planes[0], any ? &transparent : nullptr);
      for (std::uint32_t r = 0; any && r < side.row_count; ++r) {
        for (Row left = transparent[r]; left != 0; left &= left - 1)
          materials_.push_back(material_at(chunk, place.voxel(lowest_bit(left), r)));
      }
      end_side(side);
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
    const SideRows<Rows>& rows = sides[i];
    Side& side = begin_side(chunk, rdm::direction_of(a.layer, i % 2 != 0), a.bit, a.row,
                            rows.opaque, rows.materials.empty() ? nullptr : &rows.transparent);
    materials_.insert(materials_.end(), rows.materials.begin(), rows.materials.end());
    end_side(side);
  }
}
template void ChunkBorders::keep(
    const RunChunk&, const std::array<SideRows<std::array<Row32, 32>>, kDirectionCount>&);
template void ChunkBorders::keep(
    const RunChunk&, const std::array<SideRows<std::array<Row64, 64>>, kDirectionCount>&);
template void ChunkBorders::keep(
    const RunChunk&, const std::array<SideRows<std::array<Row128, 128>>, kDirectionCount>&);

template <class Rows>
ChunkBorders::Side& ChunkBorders::begin_side(const RunChunk& chunk, Direction direction,
                                             Axis bit_axis, Axis row_axis, const Rows& opaque,
                                             const Rows* transparent) {
  Side& side = sides_[static_cast<std::size_t>(direction)];
  side.bit_axis = bit_axis;
  side.row_words = static_cast<std::uint8_t>((rdm::side_of(chunk, bit_axis) + 31) / 32);
  side.row_count = static_cast<std::uint8_t>(rdm::side_of(chunk, row_axis));
  side.first = static_cast<std::uint16_t>(words_.size());
  side.first_material = static_cast<std::uint32_t>(materials_.size());
  RUNSTONE_ASSERT(side.row_count <= opaque.size() && side.row_words * 32u <= sizeof(opaque[0]) * 8);
  for (const Rows* rows : {&opaque, transparent}) {
    if (rows == nullptr) continue;
    std::size_t to = words_.size();
    words_.resize(to + std::size_t{side.row_words} * side.row_count);
    for (std::size_t r = 0; r < side.row_count; ++r) {
      auto row = (*rows)[r];
      for (unsigned w = 0; w < side.row_words; ++w) {
        words_[to++] = static_cast<std::uint32_t>(row);
        if constexpr (sizeof(row) > sizeof(std::uint32_t)) row >>= 32;
      }
    }
  }
  return side;
}

void ChunkBorders::end_side(Side& side) {
  const auto first = materials_.begin() + static_cast<std::ptrdiff_t>(side.first_material);
  const bool is_single =
      std::adjacent_find(first, materials_.end(), std::not_equal_to<>()) == materials_.end();
  if (is_single && first != materials_.end()) materials_.erase(first + 1, materials_.end());
  side.materials = static_cast<std::uint16_t>(materials_.size() - side.first_material);
}

}  // namespace runstone
