#include "server/world/stale_tiles.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "common/core/tile_keys.hpp"

namespace runstone {
namespace {

/// As many edited chunks wait at most until the tiles above them become stale.
constexpr std::size_t kEditedMax = 4'096;

void make_again(WorldState& world, const ChunkKey& key, const TileReceivers& receivers,
                const Clocks& now) {
  const TimeUs pause = kTileRemakeUs << (key.lod - 1);
  const TimeUs due = receivers.made_us ? *receivers.made_us + pause : now.steady_us;
  world.tiles.queue.make_again(key, std::max(now.steady_us + kTileRemakeUs, due));
}

}  // namespace

void make_tiles_stale(WorldState& world, const Clocks& now) {
  std::vector<ChunkKey>& chunks = world.tiles.edited;
  if (chunks.empty()) return;
  std::ranges::sort(chunks);
  chunks.erase(std::ranges::unique(chunks).begin(), chunks.end());
  // Each chunk is recorded with its own newest edit. Neighbours in the list often share theirs.
  const WorldChunks& versions = world.authority.chunks();
  const std::span<const ChunkKey> all = chunks;
  for (std::size_t first = 0, end = 0; first < all.size(); first = end) {
    const Sequence seq = versions.version(all[first]).seq;
    for (end = first + 1; end < all.size() && versions.version(all[end]).seq == seq;) ++end;
    world.environment.tiles_edited(all.subspan(first, end - first), seq);
  }
  std::optional<ChunkKey> before;
  for (const ChunkKey& chunk : chunks) {
    for (std::uint8_t level = 1; level <= world.config.tile_levels_max; ++level) {
      const ChunkKey key = tile_of(chunk.at, level);
      // The chunk before has marked this tile and those above it.
      if (before && tile_of(before->at, level) == key) break;
      if (const TileReceivers* receivers = world.tiles.receivers.find(key))
        make_again(world, key, *receivers, now);
    }
    before = chunk;
  }
  chunks.clear();
}

void tiles_edited(WorldState& world, std::span<const ChunkKey> chunks, const Clocks& now) {
  if (world.config.tile_levels_max == 0) return;
  std::vector<ChunkKey>& edited = world.tiles.edited;
  if (chunks.size() == 1 && !edited.empty() && edited.back() == chunks.front()) return;
  edited.insert(edited.end(), chunks.begin(), chunks.end());
  if (edited.size() >= kEditedMax) make_tiles_stale(world, now);
}

}  // namespace runstone
