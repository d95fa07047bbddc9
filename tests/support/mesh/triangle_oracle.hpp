// Triangle oracle: checks meshes of triangles as the face oracle checks meshes of quads, exactly
// and in integers.
//
// Triangles of one direction, plane and material, all wound outwards, cover every point of the
// plane some whole number of times. That number is a function of finite extent. Such a function is
// determined entirely by the places and sizes of its jumps. It jumps along the edges of the
// triangles, each counted with its direction; edges that run in both directions cancel. Edges
// between lattice points are cut at the lattice points that they pass, so that parts which lie on
// each other are equal. If the rest is the boundary of the expected faces, cut and cancelled in the
// same way, then every face is covered once, nothing else is covered, and no two triangles overlap.
// Otherwise one of these is false. Triangles that wind the other way would cover -1 times and are
// rejected before.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tests/reference/surface.hpp"
#include "tests/support/mesh/face_oracle.hpp"

namespace runstone::test {

/// Returns the fault of a mesh of triangles, or nullopt if there is none:
/// - a vertex that does not exist, is not used, leaves the extent or serves two directions, planes
///   or materials;
/// - a triangle across planes, without area, flipped or of an empty material;
/// - a place covered too often or too seldom compared with `expected`.
/// Cost: O(n log n) in edges and faces.
std::optional<std::string> triangles_difference(const reference::TriangleMesh& mesh, Extent extent,
                                                const MaterialTable& materials,
                                                const std::vector<UnitFace>& expected);

/// Does the same for a mesh of either kind. Only one kind may be present.
std::optional<std::string> surface_difference(const reference::Surface& surface, Extent extent,
                                              const MaterialTable& materials,
                                              const std::vector<UnitFace>& expected);

}  // namespace runstone::test
