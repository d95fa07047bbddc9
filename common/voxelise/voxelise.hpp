// The voxeliser: makes runs of triangles or of a cloud of points, without a grid. It works on beams
// of 64 x 64 rows along x. For each row it sorts the places where triangles cross it, and the
// stretches between them become runs. Vertices are snapped to 1/256 of a voxel, and from there on
// everything is exact: shared edges neither leak nor count twice (line_crossings.hpp). Pure: no
// I/O, no clock. Deterministic on one machine; colours and the winding number of open meshes use
// floating point.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/edits/clipboard/orientation.hpp"
#include "common/models/model.hpp"
#include "common/models/surface_mode.hpp"
#include "common/runs/run_chunk.hpp"
#include "common/voxelise/mesh_edges.hpp"
#include "common/voxelise/model_placement.hpp"

namespace runstone {

/// The rule by which voxels are inside.
enum class SolidRule : std::uint8_t {
  none = 0,     // no solid
  parity = 1,   // the row crosses the mesh an odd number of times before the centre
  winding = 2,  // the generalised winding number is above 1/2 or below -1/2
};

/// The radius of the points of a cloud, in voxels.
inline constexpr double kPointRadiusMax = 64;
/// The materials that a model may become, as many as an import may add.
inline constexpr std::size_t kModelColoursMax = 1024;

struct VoxeliseOptions {
  VoxelScale scale;
  Orientation turn;  // the axes of the model along those of the result
  /// The voxels whose centres are inside, and nothing else: a wall that is thinner than a voxel and
  /// has no centre in it leaves no voxel. Solid and a surface together keep it. A centre on the
  /// surface is inside if the centre moved by an infinitesimal along x, then y, then z is.
  bool is_solid = true;
  SurfaceMode surface = SurfaceMode::none;
  /// Closed meshes by winding number, too: where closed parts overlap, parity leaves a hollow. A
  /// part that is inside another one and turned inside out stays hollow.
  bool fills_overlaps = false;
  /// A voxel of a cloud is set if its centre is within this distance of a point, or the point is in
  /// it. 0 .. kPointRadiusMax voxels, in steps of 1/256.
  double point_radius = 0.5;
  std::size_t colours_max = 255;  // 1 .. kModelColoursMax
  /// Is asked after each beam. The work ends with io_failed soon after it returns false. Empty: it
  /// always goes on.
  std::function<bool()> should_continue = {};
  /// Takes the share of the work that is done, above 0 .. 1, on the thread of the call after each
  /// row of beams. It never falls. Empty: nobody wants to know.
  std::function<void(double share)> progress = {};
};

/// The voxels of a section of the result: the box from `origin` on, cut at multiples of 64.
struct VoxelPiece {
  VoxelPos origin;
  RunChunk voxels;  // 0: not part of the result; i + 1: colour i
};

struct Voxelised {
  VoxelPos sides;
  std::vector<std::array<std::uint8_t, 3>> colours;  // sRGB
  MeshClosure closure = MeshClosure::open;           // of a mesh that was made solid
  SolidRule rule = SolidRule::none;
  std::uint64_t voxels = 0;  // that are set
};

using VoxelPieceSink = std::function<Result<void>(VoxelPiece&&)>;
/// Calls f(0) .. f(count - 1), each once, in any order and on any threads, and returns when all are
/// done.
using ParallelFor =
    std::function<void(std::size_t count, const std::function<void(std::size_t)>& f)>;

/// Gives the sections that are not empty to the sink, in the order of z, y and x.
///
/// Inside: by parity if two triangles share each edge (MeshClosure closed or inverted), otherwise,
/// and with fills_overlaps, by the generalised winding number. Clouds are balls around their
/// points; the modes and is_solid do not matter to them.
///
/// Colours: a voxel on the surface has that of the nearest triangle: its material, times the
/// nearest texel, times the colours of its vertices, at the point nearest to the centre of the
/// voxel. A texel with alpha below 128 is no surface; a solid is closed there all the same. In a
/// solid a voxel is on the surface if a triangle crosses a line along an axis from its centre to
/// that of a neighbour. All other voxels of a solid have the colour of the voxel before them in
/// their row, which makes the fewest runs. More colours than `colours_max` become that many. The
/// result is opaque.
///
/// Fails as validate() does, with bad_value for an option outside its range, with limit_exceeded if
/// a side becomes longer than kVoxeliseSideMax, or if an open mesh has too many open edges for its
/// size, and with the error of the sink. A model of which no voxel is left is no error. Cost:
/// O(triangles * bands of 64 layers that each meets + crossings + runs); O(voxels touched) for
/// conservative surfaces, and for all if the model has more than one colour, when it is done twice.
/// Memory: 8 bytes a triangle, those of MeshEdges while it counts, and what is found in one beam;
/// with `parallel_for`, in the beams of 64 layers.
Result<Voxelised> voxelise(const Model& model, const VoxeliseOptions& options,
                           const VoxelPieceSink& sink, const ParallelFor& parallel_for = {});

}  // namespace runstone
