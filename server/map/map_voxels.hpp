// MapVoxels: the chunks and tiles of a moment. A tile is taken from the first of these that has it:
//   1. the tiles in memory;
//   2. the generator's coarse form, if nothing below the tile is stored or was edited;
//   3. the table of tiles of the world, if it has the version of the moment;
//   4. its eight children.
// It writes nothing. The reads of an object are joined to spans, which end with it.
// Thread: one, as its reader.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "common/mesh/visibility.hpp"
#include "common/tiles/tile_builder.hpp"
#include "common/tiles/tile_rules.hpp"
#include "server/map/map_caches.hpp"
#include "server/map/map_moment.hpp"
#include "server/store/read_span.hpp"

namespace runstone {

class MapVoxels {
 public:
  /// Returns false if the work should stop.
  using ShouldContinue = std::function<bool()>;
  using Voxels = std::shared_ptr<const RunChunk>;

  /// The arguments must outlive the object.
  /// `tile_rules` is the number of the rules that `visibility` is of.
  MapVoxels(const Generator& generator, const VisibilityTable& visibility, std::uint32_t tile_rules,
            WorldReader& reader, MapCaches& caches, ShouldContinue should_continue)
      : generator_(generator),
        visibility_(visibility),
        tile_rules_(tile_rules),
        reader_(reader),
        reads_(reader),
        caches_(caches),
        should_continue_(std::move(should_continue)) {}

  /// Returns the voxels of a chunk or tile. A damaged chunk is empty, as in the tiles of the
  /// server. Fails (cancelled) if should_continue() returned false; what was made until then is
  /// kept in the caches. Fails if the world cannot be read.
  StoreResult<Voxels> at(const MapMoment& moment, const ChunkKey& key);

 private:
  StoreResult<Voxels> chunk(const MapMoment& moment, const ChunkKey& key);
  StoreResult<Voxels> build(const MapMoment& moment, const ChunkKey& key);
  StoreResult<Voxels> stored(const ChunkKey& key, const Version& version);

  const Generator& generator_;
  const VisibilityTable& visibility_;
  const std::uint32_t tile_rules_;
  WorldReader& reader_;
  ReadSpan reads_;
  MapCaches& caches_;
  const ShouldContinue should_continue_;
  ReplayScratch replay_;
  TileScratch build_;
};

}  // namespace runstone
