// Makes the numbers of a model finite, whatever its file holds. Thread: any.
#pragma once
#include <array>

#include "common/model_reader/reader_notices.hpp"
#include "common/models/model.hpp"
#include "common/models/model_format.hpp"

namespace runstone {

/// Returns a place of a file in the axes of a world.
inline std::array<float, 3> turned(float x, float y, float z, ModelUp up) {
  if (up == ModelUp::y) return {x, y, z};
  return {x, z, -y};
}

/// Leaves out the points of a cloud, or else the triangles, that have coordinates which are not finite,
/// with a notice. Returns false if nothing is left. Vertices of no triangle that are not finite get the
/// place of another vertex, so that they do not enlarge the box around the model. Requires that triangles
/// name vertices that exist. Cost: O(bytes).
bool leave_out_not_finite(Model& model, ReaderNotices& notices);

}  // namespace runstone
