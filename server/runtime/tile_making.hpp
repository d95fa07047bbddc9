// TileMaking: makes and saves tiles for the world strand. Tiles are made by threads of their own,
// so that they delay neither chunks nor edits; the threads have a low priority. Tiles are saved by
// the log writer, a few at a time.
// Threads: the world strand, unless a call says otherwise. The threads end with stop().
#pragma once
#include <asio/thread_pool.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "common/generate/generator.hpp"
#include "common/materials/material_table.hpp"
#include "common/tiles/tile_visibility.hpp"
#include "protocol/codec/messages.hpp"
#include "server/history/chunk_source.hpp"
#include "server/runtime/low_priority_threads.hpp"
#include "server/runtime/world_strand.hpp"
#include "server/store/log_writer.hpp"
#include "server/tiles/tile_ledger.hpp"
#include "server/tiles/tile_source.hpp"
#include "server/world/environment/tile_request.hpp"

namespace runstone {

class TileMaking {
 public:
  using Tiles = std::vector<std::pair<ChunkKey, ChunkPtr>>;
  enum class End { made, stopped, failed };
  /// Brings the tiles of a request, the requested one last if it was made. `stopped`: the request
  /// has reached TileRequest::steps_max.
  using Then = std::function<void(const ChunkKey&, const std::vector<MadeTile>&, End)>;

  /// Makes a chunk as it was after an edit. Kind::cancelled: the server stops.
  using PastChunks = std::function<StoreResult<Chunk>(Sequence, const ChunkKey&)>;

  /// All must outlive the object. `past_chunks` is called on the threads of this object.
  TileMaking(WorldStrand& strand, ChunkSource& chunks, const Generator& generator,
             std::int32_t edge, PastChunks past_chunks);

  /// Makes a tile. `materials` are those in force, and `materials_seq` is the newest record that
  /// changed them.
  void make(TileRequest request, const MaterialTable& materials, Sequence materials_seq, Then then);
  /// Records that `seq` is the newest edit of these chunks. It does not wait for the other threads.
  void edited(std::span<const ChunkKey> chunks, Sequence seq);
  /// Returns the newest edit below a tile, or 0. It may wait for the other threads for a moment.
  Sequence newest_edit(const ChunkKey& tile);
  /// Returns true if the client's copy is the tile as it is now; see TileSource::is_current().
  bool is_current(const CachedChunk& copy, std::uint32_t rules);
  /// Writes tiles, which were made by `rules`, when the earlier ones are written. Drops tiles if
  /// too many wait, and those of other rules that wait. The writer must not call back after the
  /// strand has ended.
  void save(Tiles tiles, std::uint32_t rules, LogWriter& writer);

  /// Ends the threads. Waits for the tiles that are being made, and drops the requests that wait.
  /// Thread: any but those of the strand.
  void stop();

 private:
  static constexpr std::size_t kThreads = 2;
  static constexpr std::size_t kUnsavedMax = 4'096;  // tiles
  static constexpr std::size_t kSavedAtOnceMax = 256;

  void save_next(LogWriter& writer);
  /// Passes the edits that wait on to the ledger.
  void flush_edits();

  WorldStrand& strand_;
  TileLedger ledger_;
  // Edits that found the ledger in use.
  std::vector<std::pair<std::vector<ChunkKey>, Sequence>> waiting_edits_;
  TileSource source_;
  const PastChunks past_chunks_;
  std::shared_ptr<const TileVisibility> visibility_;
  Sequence materials_seq_ = 0;  // that of visibility_
  Tiles unsaved_;
  std::uint32_t unsaved_rules_ = 0;  // of unsaved_
  bool is_saving_ = false;
  const std::unique_ptr<asio::thread_pool> threads_ = low_priority_threads(kThreads);
  // Past tiles have a thread of their own, because they take long.
  const std::unique_ptr<asio::thread_pool> past_thread_ = low_priority_threads(1);
};

}  // namespace runstone
