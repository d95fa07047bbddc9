#include "common/mesh/rdm/opaque_layer.hpp"

#include "common/core/assert.hpp"
#include "common/mesh/rdm/border_rows.hpp"

namespace runstone {

template <class Row>
void read_opaque_layer(const RunChunk& chunk, const LayerOfBits& layer,
                       const VisibilityTable& visibility, std::array<Row, kRowBits<Row>>& rows) {
  const rdm::LayerPlace place{layer.axis, layer.bit_axis, layer.at};
  RUNSTONE_ASSERT(layer.axis != layer.bit_axis && layer.at < rdm::side_of(chunk, layer.axis));
  RUNSTONE_ASSERT(rdm::side_of(chunk, place.bit_axis) <= kRowBits<Row> &&
                  rdm::side_of(chunk, place.row_axis()) <= kRowBits<Row> &&
                  layer.first_row <= layer.end_row &&
                  layer.end_row <= rdm::side_of(chunk, place.row_axis()));
  std::array<std::array<Row, kRowBits<Row>>, 1> planes;
  rdm::read_layer_rows(chunk, place, {layer.first_row, layer.end_row}, planes,
                       [of = visibility.data()](Material material) -> rdm::PaletteIndex {
                         return of[material] == Visibility::opaque ? 1 : 0;
                       });
  rows = planes[0];
}
template void read_opaque_layer(const RunChunk&, const LayerOfBits&, const VisibilityTable&,
                                std::array<Row64, 64>&);
template void read_opaque_layer(const RunChunk&, const LayerOfBits&, const VisibilityTable&,
                                std::array<Row128, 128>&);

}  // namespace runstone
