// SurfaceMode: which voxels the surface of a model becomes. Its own file, because programs without
// the voxeliser let people choose it. Thread: any.
#pragma once
#include <cstdint>

namespace runstone {

/// Which voxels a surface becomes. "N-separating": no path of voxels outside the result, in which
/// neighbours share a face (6), or at least a corner (26), leads from one side of the surface to
/// the other (Huang, Yagel, Filippov, Kurzion 1998). The separating ones are subsets of the
/// conservative one. Voxels outside the box are dropped; of a point on the far side of the box the
/// last voxel counts.
enum class SurfaceMode : std::uint8_t {
  none = 0,
  /// All voxels whose closed cube a triangle touches (Schwarz and Seidel 2010). No part of the mesh
  /// is lost, but a face that lies on the plane between voxels becomes two voxels thick.
  conservative = 1,
  /// The voxels that have an edge which a triangle meets: thick. Two voxels that share a corner
  /// share a vertex of these edges, so each path between their centres can follow the edges, and
  /// does not pass the surface unseen (the intersection targets of Laine 2013). An edge parallel to
  /// the triangle does not count. Parts that lie inside a voxel are lost.
  separating_26 = 2,
  /// The voxels in which a triangle crosses one of the three lines through the centre along the
  /// axes: thin (Laine 2013, the thin voxels of Schwarz and Seidel). The lines of a voxel are
  /// half-open, so that a face between two voxels is one voxel thick. Parts between the lines are
  /// lost. Together with a solid that is closed, the border of the solid is the surface: a voxel is
  /// added only where a triangle crosses the line to the centre of a neighbour, and neither is
  /// inside.
  separating_6 = 3,
};

}  // namespace runstone
