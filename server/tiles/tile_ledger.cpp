#include "server/tiles/tile_ledger.hpp"

#include <algorithm>

#include "common/core/tile_keys.hpp"

namespace runstone {
namespace {

/// The mutex is released after so many chunks, because the world strand may wait for it.
constexpr std::size_t kSliceChunks = 256;

}  // namespace

TileLedger::Entry& TileLedger::entry_of(ChunkCoord chunk) {
  ChunkKey key{0, chunk};
  Entry& first = entries_[key];
  for (Entry* below = &first; below->above == nullptr && key.lod < kTileLevelMax;
       below = below->above) {
    key = tile_parent(key);
    below->above = &entries_[key];
  }
  return first;
}

void TileLedger::edited(ChunkCoord chunk, Sequence seq) {
  for (Entry* entry = &entry_of(chunk); entry != nullptr && entry->newest_edit < seq;
       entry = entry->above) {
    entry->newest_edit = seq;
  }
}

void TileLedger::edited(std::span<const ChunkCoord> chunks, Sequence seq) {
  const std::lock_guard lock(mutex_);
  for (const ChunkCoord chunk : chunks) edited(chunk, seq);
}

void TileLedger::edited(std::span<const ChunkKey> chunks, Sequence seq) {
  const std::lock_guard lock(mutex_);
  for (const ChunkKey& chunk : chunks) edited(chunk.at, seq);
}

bool TileLedger::try_edited(std::span<const ChunkKey> chunks, Sequence seq) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return false;
  for (const ChunkKey& chunk : chunks) edited(chunk.at, seq);
  return true;
}

void TileLedger::stored(std::span<const std::pair<ChunkKey, Version>> chunks) {
  while (!chunks.empty()) {
    const std::size_t count = std::min(chunks.size(), kSliceChunks);
    const std::lock_guard lock(mutex_);
    for (const auto& [key, version] : chunks.first(count)) {
      if (key.lod != 0) continue;
      entry_of(key.at);
      edited(key.at, version.seq);
    }
    chunks = chunks.subspan(count);
  }
}

Sequence TileLedger::newest_edit(const ChunkKey& tile) const {
  const std::lock_guard lock(mutex_);
  const Entry* entry = entries_.find(tile);
  return entry == nullptr ? 0 : entry->newest_edit;
}

bool TileLedger::is_stored_or_edited(const ChunkKey& tile) const {
  const std::lock_guard lock(mutex_);
  return entries_.contains(tile);
}

}  // namespace runstone
