#include "server/map/ground_index.hpp"

#include <algorithm>
#include <functional>

namespace runstone {

void GroundIndex::add(ChunkCoord chunk, const Version& version) {
  const VoxelBox here{{chunk.x, chunk.y, chunk.z}, {chunk.x + 1, chunk.y + 1, chunk.z + 1}};
  if (!bounds_) bounds_ = here;
  VoxelPos &low = bounds_->min, &high = bounds_->max;
  low = {std::min(low.x, here.min.x), std::min(low.y, here.min.y), std::min(low.z, here.min.z)};
  high = {std::max(high.x, here.max.x), std::max(high.y, here.max.y), std::max(high.z, here.max.z)};
  for (std::uint8_t level = 0; level <= kMapZoomMax; ++level) {
    const ChunkKey key = tile_of(chunk, level);
    const auto [entry, is_new] = keys_.try_emplace(key, version);
    Column& column = columns_[packed(column_of(key))];
    if (is_new) {
      const auto at = std::lower_bound(column.heights.begin(), column.heights.end(), key.at.y,
                                       std::greater<>());
      column.heights.insert(at, key.at.y);
    } else if (entry->second >= version) {
      return;  // All tiles above already have this version or a greater one.
    } else {
      entry->second = version;
    }
    column.version = std::max(column.version, version);
  }
}

std::optional<Version> GroundIndex::version(const ChunkKey& key) const {
  const auto found = keys_.find(key);
  if (found == keys_.end()) return std::nullopt;
  return found->second;
}

const GroundIndex::Column* GroundIndex::find(const ColumnKey& key) const {
  const auto found = columns_.find(packed(key));
  return found == columns_.end() ? nullptr : &found->second;
}

Version GroundIndex::column_version(const ColumnKey& key) const {
  const Column* column = find(key);
  return column == nullptr ? Version{} : column->version;
}

const std::vector<std::int32_t>& GroundIndex::heights(const ColumnKey& key) const {
  static const std::vector<std::int32_t> kNone;
  const Column* column = find(key);
  return column == nullptr ? kNone : column->heights;
}

}  // namespace runstone
