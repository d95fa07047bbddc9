// ShapeTable: the shapes of all materials as the mesher, the GPU and collisions read them.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/core/ids.hpp"
#include "common/core/shape.hpp"
#include "common/shapes/shape_faces.hpp"

namespace runstone {

class ShapeTable {
 public:
  /// Makes a table of cubes.
  ShapeTable() = default;
  /// Entry i is the shape of material i; ids without an entry are cubes. Requires valid shapes.
  /// Equal shapes share their faces. Cost: O(materials), and ShapeFaces for each different shape.
  explicit ShapeTable(std::span<const Shape> by_material);

  /// Returns true if every material is a cube.
  bool empty() const { return shapes_.empty(); }
  /// Returns the number of the material's shape, 1 .. shapes().size(), or 0 for a cube.
  std::uint16_t number(Material material) const {
    return material < numbers_.size() ? numbers_[material] : 0;
  }
  bool is_cube(Material material) const { return number(material) == 0; }

  struct Entry {
    Shape shape;
    ShapeFaces faces;
  };
  /// Returns the different shapes, ascending. number() - 1 is the index.
  std::span<const Entry> shapes() const { return shapes_; }
  /// Requires !is_cube(material).
  const Entry& operator[](Material material) const { return shapes_[number(material) - 1U]; }
  /// Returns a number that no other table of this process has but copies of this one, and 0 for an
  /// empty table. Caches of what was made of the shapes use it as a key.
  std::uint64_t serial() const { return serial_; }

 private:
  std::vector<std::uint16_t> numbers_;  // by material
  std::vector<Entry> shapes_;
  std::uint64_t serial_ = 0;
};

/// Shapes that several readers share.
using ShapeTablePtr = std::shared_ptr<const ShapeTable>;

}  // namespace runstone
