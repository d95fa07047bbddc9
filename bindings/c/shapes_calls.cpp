// Calls of runstone.h on shapes of materials.
#include <algorithm>
#include <memory>
#include <set>
#include <string_view>
#include <vector>

#include "bindings/c/buffer.hpp"
#include "bindings/c/runstone.h"
#include "bindings/c/shapes_handle.hpp"
#include "common/shapes/shape_faces.hpp"
#include "common/shapes/shape_kinds.hpp"

using namespace runstone;
using namespace runstone::c_interface;

namespace runstone::c_interface {

MeshMaterialsPtr mesh_materials(std::span<const Visibility> visibilities,
                                const runstone_shapes& shapes) {
  auto out = std::make_shared<MeshMaterials>(VisibilityTable(visibilities));
  if (shapes.by_material.empty()) return out;
  std::set<Shape> different;
  for (const auto& [material, shape] : shapes.by_material) different.insert(shape);
  if (different.size() > kTableShapesMax)
    refuse(RUNSTONE_LIMIT_EXCEEDED, "shapes", "have more than 4096 different ones");
  std::vector<Shape> by_material(shapes.by_material.rbegin()->first + 1U);
  std::vector<Visibility> cubes(visibilities.begin(), visibilities.end());
  cubes.resize(std::max(cubes.size(), by_material.size()), Visibility::opaque);
  std::vector<Visibility> tiles = cubes;
  for (const auto& [material, shape] : shapes.by_material) {
    by_material[material] = shape;
    cubes[material] = Visibility::empty;
    constexpr unsigned kHalf = unsigned{kShapeUnits} * kShapeUnits * kShapeUnits / 2;
    if (filled_cells(shape) < kHalf) tiles[material] = Visibility::empty;
  }
  out->cubes = VisibilityTable(cubes);
  out->tiles = VisibilityTable(tiles);
  out->shapes = ShapeTable(by_material);
  return out;
}

}  // namespace runstone::c_interface

runstone_status runstone_shapes_create(runstone_shapes** out) {
  return answer([&] {
    output(out, "out");
    create(out);
  });
}

runstone_status runstone_shapes_free(runstone_shapes* shapes) {
  return free_handle(shapes, "shapes");
}

runstone_status runstone_shapes_add(runstone_shapes* shapes, uint16_t material, uint32_t form,
                                    const runstone_local_box* boxes, size_t count) {
  return answer([&] {
    auto& by_material = live(shapes, "shapes").by_material;
    if (material == kEmpty) refuse(RUNSTONE_BAD_ARGUMENT, "material", "is 0, which is empty");
    check_at_most(form, std::uint32_t{RUNSTONE_SHAPE_CROSSED}, "form", "is unknown");
    given(boxes, "boxes");
    check_at_most(count, kShapeBoxesMax, "count", "is more boxes than a shape has");
    Shape shape{static_cast<ShapeForm>(form), {}};
    for (const runstone_local_box& box : elements(boxes, count, "boxes")) {
      shape.boxes.push_back(
          {{box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}});
    }
    if (const auto valid = check_shape(shape); !valid) refuse("boxes", valid.error());
    by_material[material] = std::move(shape);
  });
}

runstone_status runstone_shapes_add_kind(runstone_shapes* shapes, uint16_t material,
                                         const char* kind, const char* states) {
  return answer([&] {
    auto& by_material = live(shapes, "shapes").by_material;
    if (material == kEmpty) refuse(RUNSTONE_BAD_ARGUMENT, "material", "is 0, which is empty");
    const auto shape = shape_of_kind(&given(kind, "kind"), states == nullptr ? "" : states);
    if (!shape) refuse(RUNSTONE_BAD_ARGUMENT, "kind", "is no kind of shapes");
    if (shape->is_cube()) {
      by_material.erase(material);
    } else {
      by_material[material] = *shape;
    }
  });
}
