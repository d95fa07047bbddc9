// MeshMaterials: the properties of a world's materials that meshers read. They are the visibility
// of each material as a cube, as a shape and from afar, and the shapes.
#pragma once
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "common/mesh/visibility.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {

struct MeshMaterials {
  /// Every material is a cube.
  explicit MeshMaterials(const VisibilityTable& visibility = VisibilityTable({}))
      : cubes(visibility), rows(visibility), tiles(visibility) {}

  /// The visibilities for the mesh of the cubes (mesh_rdm()) and for veils: materials with a shape
  /// are empty.
  VisibilityTable cubes;
  /// The visibilities for the mesh of the shapes (mesh_shapes()): the materials have those of their
  /// rows.
  VisibilityTable rows;
  /// The visibilities for coarse levels of detail, whose cells are all cubes: a material with a
  /// shape counts as a cube if it fills at least half of its voxel, and is empty otherwise.
  VisibilityTable tiles;
  ShapeTable shapes;
  /// By material: a transparent liquid, whose surface lies lower. Empty if there is none.
  std::vector<bool> liquids;
  bool is_liquid(Material material) const { return material < liquids.size() && liquids[material]; }
};

/// Never null.
using MeshMaterialsPtr = std::shared_ptr<const MeshMaterials>;

/// Returns the shapes. The pointer shares the ownership of the materials.
inline ShapeTablePtr shapes_in(const MeshMaterialsPtr& materials) {
  return {materials, &materials->shapes};
}

}  // namespace runstone
