// Calls of runstone.h on visibilities and borders.
#include <vector>

#include "bindings/c/buffer.hpp"
#include "bindings/c/runstone.h"
#include "bindings/c/visibility_handle.hpp"

using namespace runstone;
using namespace runstone::c_interface;

runstone_status runstone_visibility_create(const uint8_t* visibilities, size_t count,
                                           runstone_visibility** out) {
  return answer([&] {
    output(out, "out");
    check_at_most(count, kMaterialCountMax, "count", "is more than there are materials");
    std::vector<Visibility> table;
    for (const std::uint8_t one : elements(visibilities, count, "visibilities")) {
      check_at_most(one, std::uint8_t{RUNSTONE_TRANSPARENT}, "visibilities",
                    "have an unknown value");
      table.push_back(static_cast<Visibility>(one));
    }
    create(out, VisibilityTable(table));
  });
}

runstone_status runstone_visibility_free(runstone_visibility* visibility) {
  return free_handle(visibility, "visibility");
}

runstone_status runstone_borders_create(const runstone_chunk* chunk,
                                        const runstone_visibility* visibility,
                                        runstone_borders** out) {
  return answer([&] {
    output(out, "out");
    const runstone_chunk& of = whole(chunk, "chunk");
    create(out, of, live(visibility, "visibility"));
  });
}

runstone_status runstone_borders_free(runstone_borders* borders) {
  return free_handle(borders, "borders");
}
