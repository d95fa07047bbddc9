#include "common/mesh/rdm/chunk_borders.hpp"

#include <algorithm>

#include "common/mesh/rdm/border_rows.hpp"
#include "common/mesh/rdm/scratch_state.hpp"

namespace runstone {

void ChunkBorders::lay_out(const RunChunk& chunk) {
  const auto sides = chunk.extent.sides();
  const auto side_of = [&sides](Axis axis) { return sides[static_cast<std::size_t>(axis)]; };
  std::size_t size = 0;
  for (const rdm::SideAxes& axes : rdm::side_axes(chunk.order)) {
    for (const bool positive : {false, true}) {
      const auto at = static_cast<std::size_t>(rdm::direction_of(axes.layer, positive));
      first_[at] = static_cast<std::uint16_t>(size);
      row_words_[at] = static_cast<std::uint8_t>((side_of(axes.bit) + 31) / 32);
      row_count_[at] = side_of(axes.row);
      bit_axis_[at] = axes.bit;
      size += std::size_t{row_words_[at]} * row_count_[at];
    }
  }
  words_.resize(size);
}

void ChunkBorders::read(const RunChunk& chunk, const VisibilityTable& visibility) {
  lay_out(chunk);
  const auto sides = chunk.extent.sides();
  if (*std::max_element(sides.begin(), sides.end()) <= 64) {
    read_sides<rdm::Row64>(chunk, visibility);
  } else {
    read_sides<rdm::Row128>(chunk, visibility);
  }
}

template <class Row>
void ChunkBorders::read_sides(const RunChunk& chunk, const VisibilityTable& visibility) {
  std::array<std::array<Row, rdm::kRowBits<Row>>, 1> rows;
  const auto sides = chunk.extent.sides();
  for (const rdm::SideAxes& axes : rdm::side_axes(chunk.order)) {
    for (const bool positive : {false, true}) {
      const auto at = static_cast<std::size_t>(rdm::direction_of(axes.layer, positive));
      const std::uint32_t layer = positive ? sides[static_cast<std::size_t>(axes.layer)] - 1u : 0u;
      bool transparent = false;
      const auto code_of = [&visibility, &transparent](Material material) -> rdm::Code {
        transparent |= visibility[material] == Visibility::transparent;
        return visibility[material] == Visibility::opaque ? 1 : 0;
      };
      rdm::read_layer_rows(chunk, {axes.layer, axes.bit, layer}, rows, code_of);
      transparent_[at] = transparent;
      keep_side(rdm::direction_of(axes.layer, positive), rows[0]);
    }
  }
}

template <class Rows>
void ChunkBorders::keep(const RunChunk& chunk, const std::array<Rows, kDirectionCount>& sides,
                        bool transparent) {
  lay_out(chunk);
  const auto axes = rdm::side_axes(chunk.order);
  for (std::size_t side = 0; side < sides.size(); ++side) {
    keep_side(rdm::direction_of(axes[side / 2].layer, side % 2 != 0), sides[side]);
  }
  transparent_.fill(transparent);
}
template void ChunkBorders::keep(const RunChunk&,
                                 const std::array<std::array<rdm::Row64, 64>, kDirectionCount>&, bool);
template void ChunkBorders::keep(const RunChunk&,
                                 const std::array<std::array<rdm::Row128, 128>, kDirectionCount>&, bool);

template <class Rows>
void ChunkBorders::keep_side(Direction side, const Rows& rows) {
  const auto at = static_cast<std::size_t>(side);
  std::uint32_t* to = words_.data() + first_[at];
  for (std::size_t r = 0; r < row_count_[at]; ++r) {
    for (unsigned w = 0; w < row_words_[at]; ++w) *to++ = static_cast<std::uint32_t>(rows[r] >> (32 * w));
  }
}

}  // namespace runstone
