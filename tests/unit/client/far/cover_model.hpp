// CoverModel: what a FarCover draws, cell by cell. A cell is the place of a chunk below one tile.
#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "client/far/far_cover.hpp"
#include "common/core/tile_keys.hpp"

namespace runstone::test {

struct CoverModel {
  ChunkKey top;
  std::set<ChunkKey> present = {};

  std::int32_t side() const { return 1 << top.lod; }

  /// Returns how many times each cell is drawn.
  std::map<ChunkCoord, int> drawn(const FarCover& cover) const {
    std::map<ChunkCoord, int> out;
    const auto add = [&out](const ChunkKey& of, int count) {
      const ChunkCoord first = first_chunk(of);
      const std::int32_t wide = 1 << of.lod;
      for (std::int32_t x = 0; x < wide; ++x) {
        for (std::int32_t y = 0; y < wide; ++y) {
          for (std::int32_t z = 0; z < wide; ++z) {
            out[{first.x + x, first.y + y, first.z + z}] += count;
          }
        }
      }
    };
    add(top, 0);
    for (const ChunkKey& key : present) {
      if (key.lod == 0) {
        add(key, cover.shows(key) ? 1 : 0);
        continue;
      }
      const TileParts parts = cover.parts(key);
      if (parts.is_whole) add(key, 1);
      for (unsigned i = 0; i < 8; ++i) {
        if ((parts.octants >> i & 1U) != 0) add(tile_child(key, i), 1);
      }
    }
    return out;
  }

  /// Returns true if something that covers the cell is present.
  bool is_known(ChunkCoord cell) const {
    for (std::uint8_t lod = 0; lod <= top.lod; ++lod) {
      if (present.contains(tile_of(cell, lod))) return true;
    }
    return false;
  }

  /// Returns the cells that are not drawn exactly once if they are known, and otherwise never.
  std::vector<ChunkCoord> faults(const FarCover& cover) const {
    std::vector<ChunkCoord> out;
    for (const auto& [cell, count] : drawn(cover)) {
      if (count != (is_known(cell) ? 1 : 0)) out.push_back(cell);
    }
    return out;
  }
};

}  // namespace runstone::test
