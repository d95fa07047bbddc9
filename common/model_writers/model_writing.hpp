// WrittenBuild and ModelWriting: what a writer of triangles gets: a build, and the choices of how
// its faces become triangles.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "common/builds/build.hpp"
#include "common/core/build_info.hpp"
#include "common/core/material_look.hpp"
#include "common/core/material_row.hpp"
#include "common/core/shape.hpp"
#include "common/core/visibility.hpp"

namespace runstone {

/// The greatest number of levels of detail besides the finest one.
inline constexpr unsigned kModelLevelsMax = 8;

/// A material of a model that is written.
struct WrittenMaterial {
  std::string name;                     // UTF-8; several may have one name
  MaterialColour colour{0, 0, 0, 255};  // sRGB and alpha
  Visibility visibility = Visibility::opaque;
  MaterialLook look;
  Shape shape;  // valid
  /// The visibility of a cube in place of the shape, which coarser levels have.
  Visibility as_cube = Visibility::opaque;
};

/// A build whose faces are written. It is borrowed for one call.
struct WrittenBuild {
  const Build& build;
  const BuildInfo& info;
  std::vector<WrittenMaterial> materials;  // by palette entry of the build
};

/// The choices of a writer.
struct ModelWriting {
  /// True: quads share a vertex of equal place and normal, within a material and a region. In an
  /// .obj they share each equal place. False: every quad has vertices of its own.
  bool is_welded = true;
  /// True: each edge of a triangle ends where an edge of another one ends, so that no seam can show
  /// and a solid build of cubes is a closed surface. It costs triangles and one more pass over the
  /// build. The planes of plants are left as they are.
  /// False: a corner of a quad may lie within an edge of its neighbour.
  bool closes_t_junctions = false;
  /// True: a .glb or .gltf has a vertex of 8 bytes instead of 24, and of 12 in regions with places
  /// between those of voxels. Readers need KHR_mesh_quantization.
  bool is_quantised = false;
  /// The levels of detail besides the finest one, at most kModelLevelsMax. A .glb or .gltf holds
  /// them. The writers of other formats do not use it: their levels are files of their own
  /// (common/build_files).
  unsigned levels = 0;
  /// The side of a voxel. Finite and above 0.
  double metres_per_voxel = 1;
  /// The name of the .mtl file that an .obj names, without folders. Empty: none. A name of several
  /// lines is left out.
  std::string material_file;
};

}  // namespace runstone
