// The object behind runstone_shapes: the shapes of materials that are no cubes.
#pragma once
#include <cstdint>
#include <map>
#include <span>

#include "bindings/c/handle.hpp"
#include "common/core/ids.hpp"
#include "common/core/shape.hpp"
#include "common/mesh/mesh_materials.hpp"

struct runstone_shapes : runstone::c_interface::Handle<0x70616873> {
  std::map<runstone::Material, runstone::Shape> by_material;  // valid, and no cubes
};

namespace runstone::c_interface {

/// Returns the materials for meshers, from visibilities by id and from shapes. Refuses more
/// different shapes than a table can have.
MeshMaterialsPtr mesh_materials(std::span<const Visibility> visibilities,
                                const runstone_shapes& shapes);

}  // namespace runstone::c_interface
