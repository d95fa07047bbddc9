// Obstacles: the materials that stop a body: cubes by their whole voxel, shapes by their boxes.
#pragma once
#include <memory>
#include <utility>

#include "common/collision/material_set.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {

class Obstacles {
 public:
  /// Makes obstacles that are all cubes.
  Obstacles(MaterialSet cubes = {})
      : cubes_(std::move(cubes)) {}  // NOLINT(google-explicit-constructor)
  /// `cubes` and `shapes` have no material in common. Requires a table in which the materials of
  /// `shapes` are no cubes, and that `shapes` has no unknown ones.
  Obstacles(MaterialSet cubes, MaterialSet shapes, std::shared_ptr<const ShapeTable> table)
      : cubes_(std::move(cubes)), shapes_(std::move(shapes)), table_(std::move(table)) {}

  const MaterialSet& cubes() const { return cubes_; }
  /// Returns true if some obstacles are no cubes.
  bool has_shapes() const { return table_ != nullptr; }
  const MaterialSet& shapes() const { return shapes_; }
  /// Requires has_shapes().
  const ShapeTable& table() const { return *table_; }
  bool contains(Material material) const {
    return cubes_.contains(material) || (has_shapes() && shapes_.contains(material));
  }

 private:
  MaterialSet cubes_, shapes_;
  std::shared_ptr<const ShapeTable> table_;  // null: all are cubes
};

}  // namespace runstone
