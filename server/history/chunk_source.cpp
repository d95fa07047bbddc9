#include "server/history/chunk_source.hpp"

#include <optional>
#include <utility>

#include "common/runs/reorder.hpp"
#include "server/history/base_chunk.hpp"

namespace runstone {

StoreResult<std::unique_ptr<WorldReader>> ChunkSource::borrow() {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      auto reader = std::move(idle_.back());
      idle_.pop_back();
      return reader;
    }
  }
  auto opened = open_world(place_, StoreAccess::read_only);
  if (!opened) return failure(opened.error());
  return *std::move(opened);
}

void ChunkSource::give_back(std::unique_ptr<WorldReader> reader) {
  if (!reader->is_usable()) return;  // the next call opens another one
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(reader));
}

StoreResult<void> ChunkSource::with_reader(const std::function<void(WorldReader&)>& use) {
  auto reader = borrow();
  if (!reader) return failure(reader.error());
  use(**reader);
  give_back(*std::move(reader));
  return {};
}

StoreResult<Chunk> ChunkSource::load(const ChunkKey& key) {
  auto reader = borrow();
  if (!reader) return failure(reader.error());
  auto chunk = load(**reader, key);
  // A connection remembers the last error of its files, and would take later damage for it.
  if (chunk || !chunk.error().may_pass()) give_back(*std::move(reader));
  return chunk;
}

StoreResult<Chunk> ChunkSource::load(ChunkReader& reader, const ChunkKey& key) const {
  auto stored = reader.load_snapshot(key);
  if (!stored) return failure(stored.error());
  if (!stored->has_value()) return base_chunk(reader, generator_, key);
  Chunk chunk = **std::move(stored);
  chunk.voxels = in_cheapest_order(std::move(chunk.voxels));
  return chunk;
}

}  // namespace runstone
