// GhostChunk: the preview of an edit in one chunk, as quads that are drawn translucent over the
// world. The meshes are made by the tool that previews the edit; the renderer only draws them.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "common/core/coords.hpp"
#include "common/mesh/chunk_mesh.hpp"

namespace runstone {

struct GhostChunk {
  /// The level is that of the mesh: a cell of it covers 1 << key.lod voxels along each axis.
  ChunkKey key;
  std::int32_t edge = 0;  // of the chunk, in voxels
  /// placed: the quads of voxels that the edit would set, drawn in the colours of their materials.
  /// removed: the quads of voxels that it would clear, drawn in red with a cross on each cell of a
  /// face. Either may be null.
  std::shared_ptr<const ChunkMesh> placed, removed;
  /// The colour of the player whose preview it is, r, g, b; nullopt: of this player. Ghosts of
  /// others are drawn in their colour.
  std::optional<std::array<std::uint8_t, 3>> tint = std::nullopt;
  /// Added to the place that the key gives. A build may be pasted anywhere.
  VoxelPos shift{};
};

}  // namespace runstone
