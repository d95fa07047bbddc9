#include "client/bots/tile_answers.hpp"

namespace runstone {

void TileAnswers::set_view(const View& view) {
  std::erase_if(is_empty_, [&view](const auto& tile) { return !contains_key(view, tile.first); });
}

bool TileAnswers::are_complete(const View& view, CoordLimit world) const {
  if (is_empty_.empty()) return false;
  bool out = true;
  for_each_tile(view, world, is_empty_.rbegin()->first.lod,
                [&](const ChunkKey& root) { out = out && is_complete_below(view, world, root); });
  return out;
}

bool TileAnswers::is_complete_below(const View& view, CoordLimit world, const ChunkKey& key) const {
  const auto found = is_empty_.find(key);
  if (found == is_empty_.end()) return false;
  if (found->second || key.lod == 1) return true;
  for (unsigned i = 0; i < kTileChildren; ++i) {
    const ChunkKey child = tile_child(key, i);
    if (has_key(view, world, child) && !is_complete_below(view, world, child)) return false;
  }
  return true;
}

}  // namespace runstone
