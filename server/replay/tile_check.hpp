// check_tiles: compares the stored tiles of a world with tiles that are made of its stored chunks.
#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "common/generate/generator.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

struct TileReport {
  std::uint64_t compared = 0;
  /// Tiles with edits below them that are in no snapshot, and tiles that a running server replaced
  /// or deleted meanwhile.
  std::uint64_t not_compared = 0;
  std::uint64_t differences = 0;  // damaged tiles and chunks included
  std::string first;              // describes the first difference; empty if there is none
};

/// Gets the number of tiles that are done, and that of all.
using TileProgress = std::function<void(std::uint64_t, std::uint64_t)>;

/// Makes each stored tile of the chunks of a world again, without reading a stored tile, and
/// compares version and digest. Tiles are a cache of snapshots and base, so the edits that only the
/// log has do not count. `store` is the world at `place`; a server may be running it. Fails if
/// the place cannot be read.
StoreResult<TileReport> check_tiles(const std::string& place, WorldReader& store,
                                    const Generator& generator, const TileProgress& progress);

}  // namespace runstone
