// GhostChunk: the preview of an edit in one chunk, as quads that are drawn translucent over the
// world. The meshes are made by the tool that previews the edit; the renderer only draws them.
#pragma once
#include <cstdint>
#include <memory>

#include "common/core/coords.hpp"
#include "common/mesh/chunk_mesh.hpp"

namespace runstone {

struct GhostChunk {
  ChunkKey key;
  std::int32_t edge = 0;  // of the chunk, in voxels
  /// placed: the quads of voxels that the edit would set, drawn in the colours of their materials.
  /// removed: the quads of voxels that it would clear, drawn in red. Either may be null.
  std::shared_ptr<const ChunkMesh> placed, removed;
};

}  // namespace runstone
