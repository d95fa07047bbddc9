// RegionMesher: the quads of one region of a build. Regions are cubes of kModelRegionEdge cells
// from the lowest corner of the build on; the last one along an axis ends with the build. Faces
// between regions are culled, and faces to untouched cells and to the outside of the build are
// kept. Thread: one at a time. Memory: the runs and quads of one region.
#pragma once
#include <cstdint>
#include <vector>

#include "common/builds/build.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/visibility.hpp"
#include "common/model_writers/model_writing.hpp"

namespace runstone {

/// The side of a region, in voxels. Places within a region fit a byte.
inline constexpr std::int32_t kModelRegionEdge = static_cast<std::int32_t>(kSideMax);

/// Place of a region in the grid of regions.
struct ModelRegionPos {
  std::int32_t x = 0, y = 0, z = 0;
  friend bool operator==(const ModelRegionPos&, const ModelRegionPos&) = default;
};

/// Returns the visibility of each cell number: untouched cells are empty. Requires a material for
/// each palette entry.
VisibilityTable visibility_of_cells(const WrittenBuild& source);

/// Returns the number of regions along each axis.
ModelRegionPos region_counts(const Build& build);
/// Returns the cells of a region.
VoxelBox region_box(const Build& build, ModelRegionPos at);

class RegionMesher {
 public:
  /// Keeps a reference to the build. Requires a material for each palette entry.
  explicit RegionMesher(const WrittenBuild& source);

  /// Returns the quads of a region, in coordinates from its lowest corner. The material of a quad
  /// is a cell number of the build. The quads ascend: opaque ones first, then by material,
  /// direction and layer. They are valid until the next call. Cost: that of cells_in() and
  /// mesh_rdm(), and O(quads * log quads).
  const std::vector<Quad>& quads_of(ModelRegionPos at);

 private:
  bool is_empty(const RunChunk& cells) const;

  const Build& build_;
  VisibilityTable visibility_;
  RdmScratch scratch_;
  ChunkMesh mesh_;
  std::vector<Quad> quads_;
};

}  // namespace runstone
