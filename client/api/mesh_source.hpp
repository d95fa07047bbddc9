// MeshSource: a chunk as it is shown and the six chunks beside it, at one moment. It has the
// arguments for the meshers of runstone::mesh:
//   mesh_chunk(*source.chunk, source.beside(), {}, *client.mesh_materials(), scratch, mesh);
// A MeshSource is immutable. Any thread may read it, also after the client was destroyed.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "common/core/coords.hpp"

namespace runstone {

struct RunChunk;

struct MeshSource {
  ChunkCoord at;
  /// Rises with each change of the chunk, or of a neighbour at the common border.
  std::uint64_t serial = 0;
  /// The chunk itself. It is never null.
  std::shared_ptr<const RunChunk> chunk;
  /// The neighbours by Direction. Null: the neighbour lies beyond the view, or the server cannot
  /// send it.
  std::array<std::shared_ptr<const RunChunk>, kDirectionCount> neighbours;

  /// Returns the neighbours as MeshNeighbours. The pointers hold as long as this object.
  std::array<const RunChunk*, kDirectionCount> beside() const {
    std::array<const RunChunk*, kDirectionCount> out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = neighbours[i].get();
    return out;
  }
};

}  // namespace runstone
