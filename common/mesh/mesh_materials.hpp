// MeshMaterials: what meshers need of the materials of a world: how they are seen, as cubes, as shapes
// and from afar.
#pragma once
#include <memory>
#include <span>
#include <utility>

#include "common/mesh/visibility.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {

struct MeshMaterials {
  /// Every material is a cube.
  explicit MeshMaterials(const VisibilityTable& visibility = VisibilityTable({}))
      : cubes(visibility), rows(visibility), tiles(visibility) {}

  /// For the mesh of the cubes (mesh_rdm()) and for veils: materials with a shape are empty.
  VisibilityTable cubes;
  /// Those of the materials' rows, for the mesh of the shapes (mesh_shapes()).
  VisibilityTable rows;
  /// For coarse levels of detail, whose cells are all cubes: a material with a shape counts as a
  /// cube if it fills at least half of its voxel, and is empty otherwise.
  VisibilityTable tiles;
  ShapeTable shapes;
};

/// Never null.
using MeshMaterialsPtr = std::shared_ptr<const MeshMaterials>;

}  // namespace runstone
