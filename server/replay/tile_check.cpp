#include "server/replay/tile_check.hpp"

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "common/core/key_text.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/materials/material_table.hpp"
#include "common/mesh/visibility.hpp"
#include "common/tiles/tile_visibility.hpp"
#include "server/history/chunk_source.hpp"
#include "server/tiles/material_visibility.hpp"
#include "server/tiles/tile_source.hpp"

namespace runstone {
namespace {

/// The tiles of a level are made of those below, which were made before.
constexpr std::size_t kCacheBytes = std::size_t{128} << 20;

/// Reports the chunks to `ledger` that have edits behind their snapshots. Every edit up to the
/// checkpoint is contained in snapshots.
StoreResult<void> find_unsaved(WorldReader& store, TileLedger& ledger) {
  const auto checkpoint = store.checkpoint();
  if (!checkpoint) return failure(checkpoint.error());
  const auto keys = store.snapshot_keys();
  if (!keys) return failure(keys.error());
  const std::map<ChunkKey, Version> snapshots(keys->begin(), keys->end());
  return store.read_log(*checkpoint + 1, kSequenceMax, [&](const EditRecord& record) {
    if (!changes_voxels(record.cause)) return true;
    std::vector<ChunkCoord> unsaved;
    for (const ChunkCoord& chunk : touched_chunks(record.edit, store.meta().chunk_edge)) {
      const auto snapshot = snapshots.find({0, chunk});
      if (snapshot == snapshots.end() || snapshot->second < record.version)
        unsaved.push_back(chunk);
    }
    ledger.edited(unsaved, record.version.seq);
    return true;
  });
}

std::string text_of(const ChunkKey& key, const Chunk& stored, const Chunk& made) {
  return "tile: chunk=" + text_of(key) + " version=" + text_of(stored.version) +
         " digest=" + to_hex(stored.digest) + ", its chunks give version=" + text_of(made.version) +
         " digest=" + to_hex(made.digest);
}

}  // namespace

StoreResult<TileReport> check_tiles(const std::string& place, WorldReader& store,
                                    const Generator& generator, const TileProgress& progress) {
  using Row = StoreResult<std::optional<Chunk>>;
  const auto fail_with = [](const StoreError& error) { return failure(error); };
  TileReport report;
  const auto differs = [&](const std::string& what) {
    if (report.differences++ == 0) report.first = what;
  };
  // The keys are read first: a tile that has its listed version after its chunks were read has had
  // it all the time, so no newer snapshot was saved below it meanwhile.
  const auto materials = store.materials();
  if (!materials) return fail_with(materials.error());
  const TileVisibility visibility = tile_visibility_of(*materials);
  const auto keys = store.tile_keys(visibility.rules);
  if (!keys) return fail_with(keys.error());
  const auto damaged = store.rows_of_no_tile();
  if (!damaged) return fail_with(damaged.error());
  for (const std::string& row : *damaged) {
    ++report.compared;
    differs(row);
  }
  if (keys->empty()) return report;
  TileLedger unsaved;
  if (const auto found = find_unsaved(store, unsaved); !found) return fail_with(found.error());

  ChunkSource chunks(place, generator);
  TileLedger ground;
  TileSource source(chunks, generator, store.meta().chunk_edge, ground, differs,
                    {kCacheBytes, false, false});
  std::uint64_t done = 0;
  for (const auto& [key, version] : *keys) {
    if (progress) progress(done++, keys->size());
    if (unsaved.newest_edit(key) != 0) {
      ++report.not_compared;
      continue;
    }
    const Row stored = store.load_tile(key, visibility.rules);
    if (!stored) {
      if (stored.error().kind != StoreError::Kind::corrupt) return fail_with(stored.error());
      ++report.compared;
      differs(stored.error().message());
      continue;
    }
    // The stored chunks contain every edit that they should: the others were left out.
    const auto made = source.make({key, kSequenceMax, {}}, visibility);
    if (!made) return fail_with(made.error());
    const Row after = store.load_tile(key, visibility.rules);
    if (!after) return fail_with(after.error());
    if (!after->has_value() || (*after)->version != version) {
      ++report.not_compared;
      continue;
    }
    ++report.compared;
    if (made->back().is_approximate) continue;  // a chunk below it is damaged, which was reported
    const Chunk& tile = *made->back().tile;
    if (tile.version != version || tile.digest != (*after)->digest)
      differs(text_of(key, **after, tile));
  }
  return report;
}

}  // namespace runstone
