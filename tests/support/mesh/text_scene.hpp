// A layer of voxels drawn with digits, and a mesher's quads of its upper side.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "tests/reference/face_plane.hpp"
#include "tests/support/mesh/mesh_scene.hpp"

namespace runstone::test {

/// Returns a plane. A digit is a material, and a point is no face. Rows lie along u and follow each
/// other along v.
reference::FacePlane plane_of(const std::vector<std::string>& rows);

/// Returns a chunk of edge 8 with a drawing of up to 6 x 6 at y = 4, one voxel away from its
/// border. Rows lie along z and follow each other along x, which are u and v of its upper side.
MeshScene scene_of(const std::vector<std::string>& rows);

/// Returns the quads that face upwards, in the drawing's coordinates and in their order.
std::vector<reference::PlaneRectangle> upper_side(std::span<const Quad> quads);

}  // namespace runstone::test
