// The looks that belong to a shape: the silhouettes of plants are for the planes of plants alone.
// Programs of version 0.2.0 take a stored row with a silhouette for damage. They refuse worlds with
// shapes, which have a later format.
#pragma once
#include <span>

#include "common/core/material_look.hpp"
#include "common/core/material_row.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns true for the patterns that are silhouettes of plants: `blades`, `flower` and `foliage`.
bool is_silhouette(MaterialPattern pattern);

/// Returns the look with which a material of this shape is stored. A silhouette becomes the pattern
/// `none` if the shape is not crossed planes. Such a look is drawn as the given one. So
/// shape and pattern are given together: a silhouette that is given before the shape is lost.
MaterialLook look_on_shape(MaterialLook look, const Shape& shape);

/// Returns the row with look_on_shape(). A row without a look has none afterwards.
MaterialRow with_look_on_shape(MaterialRow row);
/// Returns the table with look_on_shape() for each row. Cost: O(rows log rows).
MaterialTable with_looks_on_shapes(const MaterialTable& table);

/// Returns true if a look of the rows is a silhouette, whatever their shapes are. Cost: O(rows).
bool has_silhouettes(std::span<const MaterialRow> rows);
bool has_silhouettes(const MaterialTable& table);

}  // namespace runstone
