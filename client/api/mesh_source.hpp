// MeshSource: a chunk as it is shown and the six chunks beside it, at one moment. These are the
// arguments of the meshers of runstone::mesh:
//   mesh_chunk(*source.chunk, source.beside(), {}, *client.mesh_materials(), scratch, mesh);
// All of it is immutable and may be read from any thread, also after the client is gone.
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
  /// Never null.
  std::shared_ptr<const RunChunk> chunk;
  /// By Direction. Null: beyond the view, or the server cannot send it.
  std::array<std::shared_ptr<const RunChunk>, kDirectionCount> neighbours;

  /// Returns the neighbours as MeshNeighbours. The pointers hold as long as this object.
  std::array<const RunChunk*, kDirectionCount> beside() const {
    std::array<const RunChunk*, kDirectionCount> out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = neighbours[i].get();
    return out;
  }
};

}  // namespace runstone
