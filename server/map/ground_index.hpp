// GroundIndex: which chunks of a moment are stored or were edited, with their versions, and the
// same of all tiles above them. The version of a tile or of a column is the greatest one of the
// chunks below it, so equal versions of one place mean equal voxels.
// Memory: an entry for each chunk, and for each tile and each column above one.
// Threads: one writer or several readers.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "common/core/ids.hpp"
#include "server/interest/chunk_key_hash.hpp"
#include "server/map/map_geometry.hpp"

namespace runstone {

class GroundIndex {
 public:
  /// Reports a chunk that is stored or was edited. Its version may not fall. Cost: one look-up for
  /// each level.
  void add(ChunkCoord chunk, const Version& version);

  /// Returns the version of a chunk or tile, or nullopt if nothing below it is stored or was
  /// edited, so that the generator alone determines it.
  std::optional<Version> version(const ChunkKey& key) const;
  /// Returns the version of a column, or (0, 0) if there is none.
  Version column_version(const ColumnKey& key) const;
  /// Returns the y of all chunks or tiles of a column that have an entry, from the highest to the
  /// lowest.
  const std::vector<std::int32_t>& heights(const ColumnKey& key) const;
  /// Returns the smallest box around all chunks that were added, in chunks, or nullopt.
  std::optional<VoxelBox> bounds() const { return bounds_; }

 private:
  struct Column {
    Version version;
    std::vector<std::int32_t> heights;  // descending
  };
  static ChunkKey packed(const ColumnKey& key) { return {key.level, {key.x, 0, key.z}}; }
  const Column* find(const ColumnKey& key) const;

  std::unordered_map<ChunkKey, Version, ChunkKeyHash> keys_;
  std::unordered_map<ChunkKey, Column, ChunkKeyHash> columns_;  // by packed()
  std::optional<VoxelBox> bounds_;
};

}  // namespace runstone
