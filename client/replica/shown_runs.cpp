#include "client/replica/shown_runs.hpp"

#include <utility>

#include "common/runs/layer_diff.hpp"

namespace runstone {

void ShownRuns::show(TrackedChunk& chunk, ShownPtr next, std::span<EditChange* const> cause) {
  const bool whole = chunk.shown == nullptr;
  const Extent extent = next->extent;
  const DirtyLayers dirty = whole                 ? all_layers(extent)
                            : chunk.shown == next ? DirtyLayers{}
                                                  : changed_layers(*chunk.shown, *next);
  chunk.shown = std::move(next);
  chunks_.recount(chunk);
  if (!dirty.any()) return;
  chunk.serial = ++last_serial_;

  ChunkChange& change = changes_.chunk(chunk.key);
  change.serial = chunk.serial;
  change.layers.here |= dirty;
  change.whole = change.whole || whole;
  change.removed = false;
  ChangeQueue::attribute(change, cause);
  // The mesher finds the neighbours of a new chunk by itself: it knows which of them waited for it.
  if (whole) return;
  for (int i = 0; i < kDirectionCount; ++i) {
    const auto d = static_cast<Direction>(i);
    if (border_dirty(dirty, d, extent.sides()[static_cast<std::size_t>(axis_of(d))])) {
      change_border({chunk.key.lod, neighbour(chunk.key.at, d)}, opposite(d), dirty, cause);
    }
  }
}

void ShownRuns::hide(TrackedChunk& chunk) {
  const ShownPtr was_shown = std::exchange(chunk.shown, nullptr);
  chunk.serial = 0;
  chunks_.recount(chunk);
  changes_.removed(chunk.key);
  for (int i = 0; was_shown && i < kDirectionCount; ++i) {
    const auto d = static_cast<Direction>(i);
    change_border({chunk.key.lod, neighbour(chunk.key.at, d)}, opposite(d),
                  all_layers(was_shown->extent), {});
  }
}

void ShownRuns::forget(const TrackedChunk& chunk) {
  if (chunk.shown) changes_.removed(chunk.key);
}

/// Queues for the chunk `key`, if it is shown, that these layers of its neighbour on `side`
/// changed.
void ShownRuns::change_border(const ChunkKey& key, Direction side, const DirtyLayers& dirty,
                              std::span<EditChange* const> cause) {
  TrackedChunk* chunk = chunks_.find(key);
  if (chunk == nullptr || !chunk->shown) return;
  chunk->serial = ++last_serial_;
  ChunkChange& change = changes_.chunk(key);
  change.serial = chunk->serial;
  change.layers.beyond[static_cast<std::size_t>(side)] |= dirty;
  ChangeQueue::attribute(change, cause);
}

}  // namespace runstone
