// Calls of runstone.h on visibilities and borders.
#include <memory>
#include <vector>

#include "bindings/c/buffer.hpp"
#include "bindings/c/runstone.h"
#include "bindings/c/shapes_handle.hpp"
#include "bindings/c/visibility_handle.hpp"

using namespace runstone;
using namespace runstone::c_interface;

namespace {

std::vector<Visibility> given_visibilities(const std::uint8_t* visibilities, std::size_t count) {
  check_at_most(count, kMaterialCountMax, "count", "is more than there are materials");
  std::vector<Visibility> out;
  for (const std::uint8_t one : elements(visibilities, count, "visibilities")) {
    check_at_most(one, std::uint8_t{RUNSTONE_TRANSPARENT}, "visibilities", "have an unknown value");
    out.push_back(static_cast<Visibility>(one));
  }
  return out;
}

}  // namespace

runstone_status runstone_visibility_create(const uint8_t* visibilities, size_t count,
                                           runstone_visibility** out) {
  return answer([&] {
    output(out, "out");
    create(out, std::make_shared<MeshMaterials>(
                    VisibilityTable(given_visibilities(visibilities, count))));
  });
}

runstone_status runstone_visibility_create_with_shapes(const uint8_t* visibilities, size_t count,
                                                       const runstone_shapes* shapes,
                                                       runstone_visibility** out) {
  return answer([&] {
    output(out, "out");
    const std::vector<Visibility> rows = given_visibilities(visibilities, count);
    create(out, mesh_materials(rows, live(shapes, "shapes")));
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
