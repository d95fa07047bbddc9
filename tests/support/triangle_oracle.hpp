// Triangle oracle: what the face oracle says of quads, said of triangles, exactly and in integers.
//
// Triangles of one direction, plane and material, all wound outwards, cover every point of the plane some
// whole number of times. That number is a function of finite extent, and such a function is known entirely by
// where it jumps and by how much: along the edges of the triangles, each counted with its direction, where
// what runs both ways cancels. Edges between lattice points are cut at the lattice points they pass, so that
// parts which lie on each other are equal. If what remains is the boundary of the faces owed, cut and
// cancelled in the same way, every face is covered once, nothing else is covered, and no two triangles
// overlap; if it is not, that is not so. Triangles that wind the other way would cover minus once and are
// refused before.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tests/reference/surface.hpp"
#include "tests/support/face_oracle.hpp"

namespace runstone::test {

/// What is wrong with a mesh of triangles: a vertex that does not exist, is not used, leaves the extent or
/// serves two directions, planes or materials; a triangle across planes, without area, flipped or of an empty
/// material; a place covered too often or too seldom against `expected`. Nothing if all is well.
/// O(n log n) in edges and faces.
std::optional<std::string> triangles_difference(const reference::TriangleMesh& mesh, Extent extent,
                                                const MaterialTable& materials,
                                                const std::vector<UnitFace>& expected);

/// The same for a mesh of either kind; nothing may be in both.
std::optional<std::string> surface_difference(const reference::Surface& surface, Extent extent,
                                              const MaterialTable& materials,
                                              const std::vector<UnitFace>& expected);

}  // namespace runstone::test
