// RegionMesher: the quads of one region of a build, of cubes and of shapes. Regions are cubes of
// kModelRegionEdge cells from the lowest corner of the build on; the last one along an axis ends
// with the build. Faces between regions are culled, and faces to untouched cells and to the outside
// of the build are kept. Thread: one at a time. Memory: the runs and quads of one region.
#pragma once
#include <cstdint>
#include <vector>

#include "common/builds/build.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/mesh_materials.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/shapes/shape_mesher.hpp"
#include "common/mesh/visibility.hpp"
#include "common/model_writers/model_writing.hpp"

namespace runstone {

/// The side of a region, in voxels, and in sixteenths of them.
inline constexpr std::int32_t kModelRegionEdge = static_cast<std::int32_t>(kSideMax);
inline constexpr std::int32_t kModelRegionUnits = kModelRegionEdge * kShapeUnits;

/// The quads of a plane of a plant: one for each side, or one for both.
enum class PlaneSides : std::uint8_t { both, one };

/// Place of a region in the grid of regions.
struct ModelRegionPos {
  std::int32_t x = 0, y = 0, z = 0;
  friend bool operator==(const ModelRegionPos&, const ModelRegionPos&) = default;
};

/// Returns the visibility of each cell number if every material is a cube: untouched cells are
/// empty. Requires a material for each palette entry.
VisibilityTable visibility_as_cubes(const WrittenBuild& source);

/// Returns the number of regions along each axis.
ModelRegionPos region_counts(const Build& build);
/// Returns the cells of a region.
VoxelBox region_box(const Build& build, ModelRegionPos at);

class RegionMesher {
 public:
  /// Keeps a reference to the build. Requires a material for each palette entry.
  RegionMesher(const WrittenBuild& source, PlaneSides sides);

  /// Returns the quads of a region, in coordinates from its lowest corner. The material of a quad
  /// is a cell number of the build. The quads ascend: opaque ones first, then by material,
  /// direction and layer. They are valid until the next call. Cost: that of cells_in(), mesh_rdm()
  /// and mesh_shapes(), and O(quads * log quads).
  const std::vector<Quad>& quads_of(ModelRegionPos at);
  /// Returns the shapes, by cell number.
  const ShapeTable& shapes() const { return materials_.shapes; }
  /// Returns false if a region had more than kShapeQuadsMax faces of shapes, so that some are
  /// missing.
  bool is_complete() const { return is_complete_; }

 private:
  bool is_empty(const RunChunk& cells) const;
  bool is_second_side(Quad quad) const;

  const Build& build_;
  MeshMaterials materials_;
  PlaneSides sides_;
  bool is_complete_ = true;
  RdmScratch scratch_;
  ShapeScratch shape_scratch_;
  ChunkMesh mesh_;
  std::vector<Quad> quads_;
};

}  // namespace runstone
