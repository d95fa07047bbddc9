// WorldMap: the map from above of the chunks that a replica shows, of the live world or of the
// past. While it is open, each changed chunk makes the tile of its column out of date, and every
// step makes a bounded number of tiles again, those near the centre first. While it is closed it
// holds nothing. Pure. One thread.
#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <set>

#include "client/map/map_tile.hpp"
#include "client/replica/replica.hpp"

namespace runstone {

class WorldMap {
 public:
  /// The greatest memory of the tiles, in bytes. On the GPU they take up to a third of it once
  /// more. Beyond it, the tiles that are farthest from the centre are dropped.
  static constexpr std::size_t kBytesMax = 48 << 20;
  /// A step begins no tile after it has visited this many runs and columns, which takes about a
  /// millisecond.
  static constexpr std::size_t kWorkMax = 50'000;

  /// Shows tiles in these colours from now on.
  void set_materials(const MaterialTable& table);
  /// Begins to draw all shown chunks. Does nothing while it is open.
  void open(const Replica& replica);
  /// Forgets all tiles.
  void close();
  bool is_open() const { return is_open_; }

  /// Notes which tiles are out of date. Cost: O(changes).
  void take(const ReplicaChanges& changes);
  /// Makes tiles again, those near the column of voxels (x, z) first, until kWorkMax is used up.
  /// Returns true if a tile changed.
  bool step(const Replica& replica, double x, double z);
  /// Returns true if some tiles are out of date and have room.
  bool is_drawing() const { return !stale_.empty() || !unpainted_.empty(); }

  const std::map<MapTileKey, MapTile>& tiles() const { return tiles_; }
  /// Returns the voxels along a side of a tile; 0 before the first tile.
  std::int32_t edge() const { return edge_; }
  /// Returns the top of a column of voxels, or nullopt if it is not known or nothing is there.
  std::optional<ColumnTop> top(std::int32_t x, std::int32_t z) const;
  std::size_t bytes() const { return bytes_; }

 private:
  const MapTile* find(MapTileKey key) const;
  /// Returns the key of the set that is nearest to the centre. Requires a set that is not empty.
  MapTileKey nearest(const std::set<MapTileKey>& keys) const;
  /// Returns the squared distance of the middle of a tile from the centre, in voxels.
  double distance(MapTileKey key) const;
  /// Makes room for another tile. Returns false if all tiles are nearer than `key`.
  bool make_room(MapTileKey key, std::size_t tile_bytes);
  void make(const Replica& replica, MapTileKey key, std::size_t& work);
  void paint(MapTileKey key, std::size_t& work);
  void erase(MapTileKey key);
  void border_changed(MapTileKey key);

  bool is_open_ = false;
  MapMaterials materials_;
  std::int32_t edge_ = 0;
  std::map<MapTileKey, MapTile> tiles_;
  std::size_t bytes_ = 0;               // of tiles_
  std::set<MapTileKey> stale_;          // to be made from the chunks
  std::set<MapTileKey> unpainted_;      // of tiles_, to be painted
  std::set<MapTileKey> dropped_;        // tiles for which there is no room
  double centre_x_ = 0, centre_z_ = 0;  // voxels
};

}  // namespace runstone
