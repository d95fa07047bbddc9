// Binary greedy mesher with 64-bit words (thesis 4.2.8): the fastest dense reference mesher, and
// the product's baseline. The faces of a line come from shifts and differences of whole words. For
// each direction and layer the words are merged by runs of set bits, widest first, then as high as
// possible. Materials are compared only where a chunk has more than one. Equal transparent
// materials cull each other, different ones do not.
#pragma once
#include <cstdint>
#include <vector>

#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/visibility.hpp"
#include "tests/reference/dense_grid.hpp"
#include "tests/reference/occupancy_mask.hpp"
#include "tests/reference/palette_decode.hpp"

namespace runstone::reference {

/// Buffers that are reused between calls, so that a steady state allocates nothing. Thread: one.
struct BinaryScratch {
  PaletteVolume volume;               // of the functions that decode
  OccupancyMask mask;                 // of those that make their mask from a grid of materials
  DenseGrid grid;                     // of a chunk with too many materials for a palette
  std::vector<std::uint64_t> planes;  // faces across the words' axis, a plane of words a layer
  std::vector<Quad> quads;
};

/// Replaces `out` by the mesh of `grid`. The mesh has the faces of mesh_rdm() and the same order of
/// directions and layers. Requires mask == occupancy_of(grid) and sides up to kBinarySideMax. Cost:
/// O(lines + faces).
void mesh_binary_greedy(const DenseGrid& grid, const OccupancyMask& mask, BinaryScratch& scratch,
                        ChunkMesh& out);

/// Does the same with palette ids.
void mesh_binary_greedy(const PaletteVolume& volume, BinaryScratch& scratch, ChunkMesh& out);

/// Does the same from a grid alone: builds the mask first.
void mesh_binary_greedy(const DenseGrid& grid, const VisibilityTable& visibility,
                        BinaryScratch& scratch, ChunkMesh& out);

/// Does the same from runs: decodes palette ids and mask in one pass, and meshes. This is "decode +
/// binary greedy" wherever meshers are compared. A chunk with too many materials for a palette is
/// decoded to a grid of materials. Counts a dense expansion.
void mesh_binary_greedy(const RunChunk& chunk, const GridNeighbours& neighbours,
                        const VisibilityTable& visibility, BinaryScratch& scratch, ChunkMesh& out);

}  // namespace runstone::reference
