// TileSource: makes tiles of a world: levels of detail of its chunks. A tile is taken from the
// first of these that has it:
//   1. the tiles that were made lately, in memory;
//   2. the generator's coarse form, from level kCoarseLevelMin on, if nothing below the tile is
//      stored or edited. It is an approximation;
//   3. the table of tiles of the world;
//   4. its eight children, which are chunks or tiles of the level below.
// A tile of 1 or 3 is used only if no edit below it is newer, and if it was made by the rules that
// TileVisibility names. A damaged row of a tile is reported and the tile is made again. A damaged
// chunk is reported, and the tiles above it show nothing there.
// Threads: any. Calls block on the disk, so workers make them.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/generate/generator.hpp"
#include "common/tiles/tile_visibility.hpp"
#include "server/history/chunk_source.hpp"
#include "server/tiles/tile_cache.hpp"
#include "server/tiles/tile_ledger.hpp"
#include "server/world/environment/tile_request.hpp"

namespace runstone {

/// The lowest level at which the generator may make a tile without chunks. Below it, at most 64
/// chunks are generated for a tile.
inline constexpr std::uint8_t kCoarseLevelMin = 3;

class TileSource {
 public:
  struct Options {
    std::size_t cache_bytes = std::size_t{16} << 20;  // of the tiles that were made lately
    /// False: no tile is read from the store, so that stored tiles can be compared with others.
    bool reads_stored_tiles = true;
    bool adds_veils = true;  // false: made tiles have no MadeTile::veiled
  };
  /// Reports a damaged row. The text names file, table and row.
  using Warn = std::function<void(const std::string&)>;

  /// Chunk source, generator and ledger must outlive the object. `edge` is that of the world's
  /// chunks. `warn` is called on the threads that call make().
  TileSource(ChunkSource& chunks, const Generator& generator, std::int32_t edge, TileLedger& ledger,
             Warn warn, Options options);
  TileSource(ChunkSource& chunks, const Generator& generator, std::int32_t edge, TileLedger& ledger,
             Warn warn)
      : TileSource(chunks, generator, edge, ledger, std::move(warn), Options()) {}

  /// Makes a chunk as it was after edit TileRequest::at.
  using PastChunk = std::function<StoreResult<Chunk>(const ChunkKey&)>;

  /// Returns the tile as the last of the list, with MadeTile::veiled. The tiles below it that were
  /// made on the way and are worth storing come before it. If request.steps_max is reached, the
  /// call stops between two tiles, and the list lacks the requested one. The next call finds the
  /// tiles that this one made in memory. The first call reads the keys of all stored chunks.
  /// Requires a tile inside the world, and that every edit up to request.head was reported to the
  /// ledger. Fails if the world cannot be read. A request with `at` also requires `past_chunk` and
  /// request.past_made. A tile below which an edit is later than `at` is made of its children at
  /// that moment. It is a past tile (MadeTile::is_past), which is kept in request.past_made alone.
  /// Other tiles are the present ones.
  StoreResult<std::vector<MadeTile>> make(const TileRequest& request,
                                          const TileVisibility& visibility,
                                          const PastChunk& past_chunk = {});
  /// Returns true if a copy of this version and with this claim_digest() is the tile as it is now.
  /// Requires that the copy was made by `rules`, the rules in force. The function makes no tile and
  /// reads none from the disk. If the tile with its veil is in memory, the digests are compared.
  /// Otherwise the version must be that of the newest edit below the tile. Returns false before the
  /// first make(), because the edits before the start are not known then. Cost: two look-ups. The
  /// function may wait for other threads for a moment.
  bool is_current(const ChunkKey& key, const Version& version, std::uint64_t claim_digest,
                  std::uint32_t rules);

 private:
  class Making;  // one call of make()
  /// Passes the chunks that are stored to the ledger, unless it was done.
  StoreResult<void> find_ground();
  /// Adds MadeTile::veiled, unless the tile has it.
  void add_veiled(MadeTile& tile, const TileVisibility& visibility);
  /// Reports a damaged row, once for each key.
  void warn_once(const ChunkKey& key, const std::string& line);

  ChunkSource& chunks_;
  const Generator& generator_;
  const std::int32_t edge_;
  TileLedger& ledger_;
  const Warn warn_;
  const Options options_;
  TileCache cache_;
  std::atomic<bool> has_found_ground_{false};
  std::mutex mutex_;  // a leaf: guards warned_
  std::set<ChunkKey> warned_;
};

}  // namespace runstone
