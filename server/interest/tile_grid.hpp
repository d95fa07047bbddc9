// TileGrid: a byte for each tile of a view. The tiles of a level lie in a box around the centre of
// the view, so the remainders of their coordinates by the sides of the box are different, and are
// their place in the grid. A view that moves needs no copy: the tiles that leave free the places of
// those that come. One thread.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/tile_keys.hpp"
#include "protocol/codec/view_tiles.hpp"

namespace runstone {

template <class Value>
class TileGrid {
 public:
  /// Gives all tiles the value Value{}. `radius`: View::radius_h.
  void reset(std::uint8_t radius) {
    side_ = 2 * std::int32_t{radius} + 1;
    for (auto& level : levels_) level.clear();
  }
  /// Returns the value of a tile. Requires a tile of the view.
  Value at(const ChunkKey& key) const {
    const std::vector<Value>& level = levels_[key.lod - 1U];
    return level.empty() ? Value{} : level[place_of(key.at)];
  }
  /// Sets the value of a tile. Requires a tile of the view.
  void set(const ChunkKey& key, Value value) {
    std::vector<Value>& level = levels_[key.lod - 1U];
    if (level.empty())
      level.resize(static_cast<std::size_t>(side_) * kHeight * static_cast<std::size_t>(side_));
    level[place_of(key.at)] = value;
  }

 private:
  static constexpr std::size_t kHeight = 2 * kTileRadiusV + 1;

  std::size_t place_of(ChunkCoord at) const {
    const auto rest = [](std::int32_t c, std::int32_t by) {
      return static_cast<std::size_t>(c - by * floor_div(c, by));
    };
    const auto side = static_cast<std::size_t>(side_);
    return (rest(at.x, side_) * side + rest(at.z, side_)) * kHeight +
           rest(at.y, static_cast<std::int32_t>(kHeight));
  }

  std::int32_t side_ = 1;
  std::array<std::vector<Value>, kTileLevelMax> levels_;  // empty: all have the value Value{}
};

}  // namespace runstone
