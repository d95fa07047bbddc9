// MesherCase: one mesher with one volume as its input. The input is ready and the buffers are warm,
// so that a call times exactly the steps that the name states.
//   rdm               the product, from runs; borders are read from the neighbours' runs
//   rdm_kept          the same with the borders of all neighbours kept (ChunkBorders); those of the
//                     chunk itself are made inside the time
//   rdm_plain         rdm without vector instructions
//   decode_binary     binary greedy from runs: palette ids and mask in one pass, mesh
//   padded_binary     the same from a list of runs with its border ready; sides up to 62
//   grid_binary       binary greedy with the dense grid of materials ready: mask, mesh
//   mask_binary       binary greedy with palette ids and occupancy mask ready: mesh
//   culled            culled faces over samples of an octree: octree, mesh
//   simple            six quads a voxel, dense grid ready: mesh
//   greedy            greedy meshing, dense grid ready: mesh
//   naive_greedy      naive greedy meshing, dense grid ready: mesh
//   run_strips        Sector's Edge's runs, ended by hidden faces, dense grid ready: mesh
//   run_strips_hidden the same as in the game: runs continue over hidden faces and draw them
//   optimal_greedy    the fewest possible rectangles, dense grid ready: mesh
//   monotone          outlines cut into monotone polygons, then triangles, dense grid ready: mesh
//   poly2tri          outlines and their constrained Delaunay triangulation, dense grid ready: mesh
//   grid_rdm          the thesis' Grid RDM, dense grid ready: mesh
//   rle_rdm           the thesis' RLE RDM, from runs in its own order: mesh
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include "bench/worlds/voxel_world.hpp"
#include "tests/reference/surface.hpp"

namespace runstone::bench {

enum class Phase : std::uint8_t { decode, octree, mask, mesh };
inline constexpr std::size_t kPhaseCount = 4;
inline constexpr std::array<std::string_view, kPhaseCount> kPhaseNames = {"decode", "octree",
                                                                          "mask", "mesh"};

/// Nanoseconds by Phase. A mesher with phases before `mesh` adds to them; the rest of a call is
/// `mesh`.
using PhaseTimes = std::array<std::uint64_t, kPhaseCount>;

struct MesherCase {
  std::string_view name;
  std::function<void(PhaseTimes&)> mesh;  // makes one mesh in the case's buffers
  std::function<std::size_t()> quads;     // of the last mesh; 0 if it consists of triangles
  /// Replaces a surface by the last mesh.
  std::function<void(reference::Surface&)> surface;
  std::size_t storage_bytes = 0;  // of the voxels as the mesher keeps them between meshes
};

/// Returns all names, in the order above.
std::span<const std::string_view> mesher_case_names();

/// Returns a mesher case, or nullopt if the mesher cannot take the volume: binary greedy requires
/// sides of at most 64, with padded runs 62. `volume` and `visibility` must outlive it. Aborts on an unknown name.
std::optional<MesherCase> make_mesher_case(std::string_view name, const Volume& volume,
                                           const VisibilityTable& visibility);

}  // namespace runstone::bench
