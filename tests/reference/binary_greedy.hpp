// Binary greedy mesher with 64-bit words (thesis 4.2.8): the best dense mesher, and the one ours is measured
// against. Faces of a line come from shifts and differences of whole words; per direction and layer the words
// are merged widest first, then as high as they go, by runs of set bits; materials are compared only where a
// chunk has more than one. Equal transparent materials cull each other, different ones do not.
#pragma once
#include <cstdint>
#include <vector>

#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/visibility.hpp"
#include "tests/reference/dense_grid.hpp"
#include "tests/reference/occupancy_mask.hpp"

namespace runstone::reference {

/// Buffers reused between calls; steady state allocates nothing. Belongs to one thread.
struct BinaryScratch {
  OccupancyMask mask;                 // of the entry points that make their own
  DenseGrid grid;                     // of the one that decodes
  std::vector<Material> layer;        // likewise: one border layer
  std::vector<std::uint64_t> planes;  // faces across the words' axis, a plane of words a layer
  std::vector<Quad> quads;
};

/// Replaces `out` by the mesh of `grid`, its occupancy mask ready: the same faces as mesh_rdm(), the same
/// order of directions and layers. Requires mask == occupancy_of(grid) and sides up to kBinarySideMax.
/// O(lines + faces).
void mesh_binary_greedy(const DenseGrid& grid, const OccupancyMask& mask, BinaryScratch& scratch,
                        ChunkMesh& out);

/// The same from a grid alone: builds the mask first.
void mesh_binary_greedy(const DenseGrid& grid, const VisibilityTable& visibility,
                        BinaryScratch& scratch, ChunkMesh& out);

/// The same from runs: decodes a grid, makes its mask from the runs as well, and meshes. What "decode +
/// binary greedy" means wherever meshers are compared. Counts a dense expansion.
void mesh_binary_greedy(const RunChunk& chunk, const GridNeighbours& neighbours,
                        const VisibilityTable& visibility, BinaryScratch& scratch, ChunkMesh& out);

}  // namespace runstone::reference
