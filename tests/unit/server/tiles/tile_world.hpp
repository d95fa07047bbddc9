// TileWorld: a small world on disk with chunks that a test changes, and a model of them in memory.
// It is for tests of tiles: its "edits" set runs of voxels in some chunks, and its log has a record
// for each of them that says nothing about the voxels.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/core/hash.hpp"
#include "common/core/tile_keys.hpp"
#include "common/generate/generator.hpp"
#include "common/mesh/visibility.hpp"
#include "common/tiles/tile_rules.hpp"
#include "server/history/base_chunk.hpp"
#include "server/history/chunk_source.hpp"
#include "server/store/store.hpp"
#include "server/tiles/tile_source.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {

class TileWorld {
 public:
  explicit TileWorld(const GeneratorPin& pin, std::uint64_t seed = 1) : random(seed) {
    WorldMeta meta = sample_meta();
    meta.generator = pin;
    generator = *make_generator(pin, meta.materials);
    store = *create_world(folder.path(), meta);
    start();
  }

  /// Starts the server's side anew, as after a crash: what is in no snapshot is reported again.
  void start() {
    source.reset();
    chunk_source.reset();
    store.reset();
    store = *open_world(folder.path(), StoreAccess::read_write);
    epoch = *store->raise_epoch();
    ledger = std::make_unique<TileLedger>();
    chunk_source = std::make_unique<ChunkSource>(folder.path(), *generator);
    source =
        std::make_unique<TileSource>(*chunk_source, *generator, kSampleEdge, *ledger,
                                     [this](const std::string& text) { warnings.push_back(text); });
    for (const ChunkCoord& at : unsaved)
      ledger->edited(std::span(&at, 1), chunks.at(at)->version.seq);
  }

  /// Returns the chunk as the last edit left it.
  ChunkPtr chunk(ChunkCoord at) const {
    const auto edited = chunks.find(at);
    if (edited != chunks.end()) return edited->second;
    return std::make_shared<const Chunk>(generated_chunk(*generator, {0, at}, kSampleEdge));
  }

  /// Makes one edit: it sets some runs of voxels in each of these chunks.
  void edit(const std::vector<ChunkCoord>& touched) {
    ++head;
    REQUIRE(store->append({}, sample_records(random, epoch, head, 1)).has_value());
    for (const ChunkCoord& at : touched) {
      Chunk next = *chunk(at);
      next.version = {epoch, head};
      for (int i = 0; i < 4; ++i) {
        const auto first = random.below(next.voxels.volume() - 300);
        fill(next.voxels, first, 1 + random.below(300), static_cast<Material>(random.below(6)));
      }
      next.digest = digest_of(next.voxels);
      chunks[at] = std::make_shared<const Chunk>(std::move(next));
      unsaved.insert(at);
    }
    ledger->edited(touched, head);
  }

  /// Saves snapshots of these chunks.
  void save(const std::set<ChunkCoord>& which) {
    std::vector<std::pair<ChunkKey, ChunkPtr>> snapshots;
    for (const ChunkCoord& at : which) snapshots.emplace_back(ChunkKey{0, at}, chunks.at(at));
    REQUIRE(store->save_snapshots(snapshots, std::nullopt).has_value());
    for (const ChunkCoord& at : which) unsaved.erase(at);
  }
  void save_all() { save(std::set<ChunkCoord>(unsaved)); }

  /// Returns a request with all chunks that are not saved.
  TileRequest request(const ChunkKey& key) const {
    TileRequest out{key, head, {}};
    for (const ChunkCoord& at : unsaved) {
      if (tile_of(at, key.lod) == key) out.fresh.emplace_back(at, chunks.at(at));
    }
    return out;
  }
  /// Returns the same for the tile as it was after edit `at`.
  TileRequest past_request(const ChunkKey& key, Sequence at) const {
    TileRequest out = request(key);
    out.at = at;
    out.past_made = std::make_shared<std::map<ChunkKey, MadeTile>>();
    return out;
  }
  std::vector<MadeTile> make(const ChunkKey& key) {
    auto made = source->make(request(key), *visibility);
    if (!made) FAIL(made.error().message());
    return *std::move(made);
  }
  /// Saves the tiles that are worth it.
  void save_tiles(const std::vector<MadeTile>& made) {
    std::vector<std::pair<ChunkKey, ChunkPtr>> tiles;
    for (const MadeTile& tile : made) {
      if (tile.is_worth_storing()) tiles.emplace_back(tile.key, tile.tile);
    }
    REQUIRE(store->save_tiles(tiles, kTileRules).has_value());
  }
  std::string file() const { return folder / "world.sqlite"; }

  SplitMix64 random;
  TempFolder folder;
  std::unique_ptr<Generator> generator;
  std::unique_ptr<Store> store;
  std::unique_ptr<TileLedger> ledger;
  std::unique_ptr<ChunkSource> chunk_source;
  std::unique_ptr<TileSource> source;
  std::vector<std::string> warnings;
  std::shared_ptr<const VisibilityTable> visibility =
      std::make_shared<const VisibilityTable>(visibilities(default_material_table()));
  Epoch epoch = 0;
  Sequence head = 0;
  std::map<ChunkCoord, ChunkPtr> chunks;  // that were edited
  std::set<ChunkCoord> unsaved;           // of them, those whose newest voxels are in no snapshot
};

}  // namespace runstone::test
