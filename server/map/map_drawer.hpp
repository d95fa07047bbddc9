// MapDrawer: draws tiles of the map of a moment, from runs. Slopes at the borders of a tile come
// from the columns beside it, so tiles fit together.
// Thread: one, as its reader.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/map/map_tops.hpp"
#include "server/map/map_caches.hpp"
#include "server/map/map_voxels.hpp"

namespace runstone {

class MapDrawer {
 public:
  /// The arguments must outlive the object.
  MapDrawer(const Generator& generator, const MapMaterials& materials, MapVoxels& voxels,
            MapCaches& caches)
      : generator_(generator), materials_(materials), voxels_(voxels), caches_(caches) {}

  /// Returns the greatest version of all columns that the tile shows or depends on. Equal versions
  /// mean equal pictures. Cost: O(columns of chunks).
  static Version version(const MapMoment& moment, const MapPlace& place);
  /// Returns the picture as a PNG file. Fails as MapVoxels::at().
  StoreResult<std::shared_ptr<const std::string>> draw(const MapMoment& moment,
                                                       const MapPlace& place);
  /// Returns the tops of a column of chunks or tiles. Heights count in voxels of its level. Fails
  /// as MapVoxels::at().
  StoreResult<std::shared_ptr<const MapTops>> tops(const MapMoment& moment, const ColumnKey& key);

 private:
  /// Returns the y of all chunks of a column that can have voxels, from the highest to the lowest.
  std::vector<std::int32_t> heights(const MapMoment& moment, const ColumnKey& key) const;

  const Generator& generator_;
  const MapMaterials& materials_;
  MapVoxels& voxels_;
  MapCaches& caches_;
};

}  // namespace runstone
