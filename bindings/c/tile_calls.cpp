// Calls of runstone.h on levels of detail.
#include <array>

#include "bindings/c/runstone.h"
#include "bindings/c/visibility_handle.hpp"
#include "common/core/thread_scratch.hpp"
#include "common/tiles/tile_builder.hpp"
#include "common/tiles/veil.hpp"

using namespace runstone;
using namespace runstone::c_interface;

runstone_status runstone_tile_build(const runstone_chunk* const children[8], uint32_t edge,
                                    uint32_t order, const runstone_visibility* visibility,
                                    runstone_chunk** out) {
  return answer([&] {
    output(out, "out");
    given(children, "children");
    const auto tile_edge = static_cast<unsigned>(edge_of(edge));
    const AxisOrder axis_order = order_of(order);
    const VisibilityTable& table = live(visibility, "visibility").materials->tiles;
    TileChildren of{};
    for (std::size_t i = 0; i < of.size(); ++i) {
      if (children[i] == nullptr) continue;
      of[i] = &whole(children[i], "children").runs;
      if (of[i]->extent != Extent::cube(tile_edge))
        refuse(RUNSTONE_BAD_ARGUMENT, "children", "are no cubes of the edge");
    }
    create(out, with_scratch<TileScratch>([&](TileScratch& scratch) {
             return build_tile(of, tile_edge, axis_order, table, scratch);
           }));
  });
}

runstone_status runstone_tile_veil(runstone_chunk* tile, const runstone_visibility* visibility) {
  return answer([&] {
    runstone_chunk& changed = whole(tile, "tile");
    const VisibilityTable& table = live(visibility, "visibility").materials->tiles;
    auto veil = with_scratch<VeilScratch>(
        [&](VeilScratch& scratch) { return veiled(changed.runs, table, scratch); });
    if (!veil) return;
    changed.runs = *std::move(veil);
    changed.digest.reset();
    changed.forget_past();
  });
}
