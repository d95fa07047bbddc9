// KeptBorders: the borders of chunks that were meshed as a whole, so that the meshes of the chunks
// beside them need not read their runs. A mesh makes the borders of its own chunk at little cost
// (mesh_rdm()). Borders are used only for the runs that they were made from. One thread.
#pragma once
#include <cstddef>
#include <map>
#include <memory>

#include "client/replica/tracked_chunk.hpp"
#include "common/core/coords.hpp"
#include "common/mesh/rdm/chunk_borders.hpp"

namespace runstone {

/// The pointer is null if there are no borders.
using BordersPtr = std::shared_ptr<const ChunkBorders>;

class KeptBorders {
 public:
  /// Replaces the borders of a chunk. `of`: the runs from which they were made. Cost of this
  /// function and the next two: O(log chunks).
  void keep(const ChunkKey& key, const ShownPtr& of, BordersPtr borders);
  /// Returns the borders of a chunk, or null if there are none of these runs.
  BordersPtr find(const ChunkKey& key, const ShownPtr& of) const;
  void erase(const ChunkKey& key);
  void clear();
  /// Returns the size of the borders, in bytes.
  std::size_t bytes() const { return bytes_; }

 private:
  struct Entry {
    std::weak_ptr<const RunChunk> of;
    BordersPtr borders;
  };
  std::map<ChunkKey, Entry> entries_;
  std::size_t bytes_ = 0;
};

}  // namespace runstone
