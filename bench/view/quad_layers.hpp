// The quads of any mesher as a mesh that the client's renderer draws.
#pragma once
#include <span>

#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/visibility.hpp"

namespace runstone::bench {

/// Sorts quads into the passes and layers of a mesh, whatever their order. Cost: O(quads log
/// quads).
ChunkMesh layered(std::span<const Quad> quads, const VisibilityTable& visibility);

}  // namespace runstone::bench
