// A layer of voxels drawn with digits, and what a mesher makes of its upper side.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "tests/reference/face_plane.hpp"
#include "tests/support/mesh_scene.hpp"

namespace runstone::test {

/// Planes and scenes alike: a digit is a material, a point none. Rows lie along u, from the first on along v.
reference::FacePlane plane_of(const std::vector<std::string>& rows);

/// A chunk of edge 8 with a picture of up to 6 x 6 at y = 4, one voxel away from its border: rows along z, from
/// the first on along x, which are u and v of its upper side.
MeshScene scene_of(const std::vector<std::string>& rows);

/// The quads that look up, in the picture's places and in their order.
std::vector<reference::PlaneRectangle> upper_side(std::span<const Quad> quads);

}  // namespace runstone::test
