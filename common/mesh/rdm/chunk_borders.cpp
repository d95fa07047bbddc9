#include "common/mesh/rdm/chunk_borders.hpp"

#include <algorithm>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/border_rows.hpp"
#include "common/mesh/rdm/side_axes.hpp"

namespace runstone {

void ChunkBorders::lay_out(const RunChunk& chunk) {
  extent_ = chunk.extent;
  order_ = chunk.order;
  std::size_t size = 0;
  for (const rdm::SideAxes& axes : rdm::side_axes(chunk.order)) {
    for (const bool positive : {false, true}) {
      const auto at = static_cast<std::size_t>(rdm::direction_of(axes.layer, positive));
      first_[at] = static_cast<std::uint16_t>(size);
      row_words_[at] = static_cast<std::uint8_t>((rdm::side_of(chunk, axes.bit) + 31) / 32);
      row_count_[at] = static_cast<std::uint8_t>(rdm::side_of(chunk, axes.row));
      bit_axis_[at] = axes.bit;
      size += std::size_t{row_words_[at]} * row_count_[at];
    }
  }
  words_.resize(size);
}

void ChunkBorders::read(const RunChunk& chunk, const VisibilityTable& visibility) {
  if (chunk.is_uniform()) {
    words_.clear();
    transparent_.fill(false);
    return;
  }
  lay_out(chunk);
  const auto sides = chunk.extent.sides();
  if (*std::max_element(sides.begin(), sides.end()) <= 64) {
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
      const Direction side = rdm::direction_of(axes.layer, positive);
      const std::uint32_t layer = positive ? rdm::side_of(chunk, axes.layer) - 1 : 0;
      rdm::read_layer_rows(chunk, {axes.layer, axes.bit, layer}, planes,
                           [of = visibility.data()](Material material) -> rdm::PaletteIndex {
                             static_assert(static_cast<int>(Visibility::opaque) == 1 &&
                                           static_cast<int>(Visibility::transparent) == 2);
                             return static_cast<rdm::PaletteIndex>(of[material]);
                           });
      transparent_[static_cast<std::size_t>(side)] =
          std::any_of(planes[1].begin(), planes[1].end(), [](Row row) { return row != 0; });
      keep_side(side, planes[0]);
    }
  }
}

template <class Rows>
void ChunkBorders::keep(const RunChunk& chunk, const std::array<Rows, kDirectionCount>& sides,
                        const std::array<bool, kDirectionCount>& transparent) {
  lay_out(chunk);
  const auto axes = rdm::side_axes(chunk.order);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Direction side = rdm::direction_of(axes[i / 2].layer, i % 2 != 0);
    keep_side(side, sides[i]);
    transparent_[static_cast<std::size_t>(side)] = transparent[i];
  }
}
template void ChunkBorders::keep(const RunChunk&,
                                 const std::array<std::array<Row64, 64>, kDirectionCount>&,
                                 const std::array<bool, kDirectionCount>&);
template void ChunkBorders::keep(const RunChunk&,
                                 const std::array<std::array<Row128, 128>, kDirectionCount>&,
                                 const std::array<bool, kDirectionCount>&);

template <class Rows>
void ChunkBorders::keep_side(Direction side, const Rows& rows) {
  const auto at = static_cast<std::size_t>(side);
  RUNSTONE_ASSERT(row_count_[at] <= rows.size() && row_words_[at] * 32u <= sizeof(rows[0]) * 8);
  std::uint32_t* to = words_.data() + first_[at];
  for (std::size_t r = 0; r < row_count_[at]; ++r) {
    auto row = rows[r];
    for (unsigned w = 0; w < row_words_[at]; ++w) {
      *to++ = static_cast<std::uint32_t>(row);
      row >>= 32;
    }
  }
}

}  // namespace runstone
