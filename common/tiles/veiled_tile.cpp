#include "common/tiles/veiled_tile.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "common/runs/reorder.hpp"

namespace runstone {
namespace {

bool is_empty(const RunChunk* child) {
  return child == nullptr || (child->is_uniform() && child->runs.material(0) == kEmpty);
}

/// Returns the axis order of most runs of the children, in which few of them have to be turned.
AxisOrder order_of_most(const TileChildren& children) {
  std::array<std::size_t, kAxisOrderCount> runs{};
  for (const RunChunk* child : children) {
    if (child != nullptr && !child->is_uniform())
      runs[static_cast<std::size_t>(child->order)] += child->runs.size();
  }
  return kAxisOrders[static_cast<std::size_t>(std::max_element(runs.begin(), runs.end()) -
                                              runs.begin())];
}

}  // namespace

RunChunk veiled(RunChunk tile, const VisibilityTable& visibility, VeiledTileScratch& scratch) {
  tile = in_cheapest_order(std::move(tile));
  veil(tile, visibility, scratch.veil);
  return tile;
}

RunChunk veiled_tile(const TileChildren& children, unsigned edge, const VisibilityTable& visibility,
                     VeiledTileScratch& scratch) {
  if (std::all_of(children.begin(), children.end(), is_empty))
    return uniform_chunk(Extent::cube(edge), kEmpty);
  return veiled(build_tile(children, edge, order_of_most(children), visibility, scratch.build),
                visibility, scratch);
}

}  // namespace runstone
