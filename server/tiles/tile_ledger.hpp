// TileLedger: the tiles below which a chunk is stored or was edited, so that the generator alone
// does not determine them, and the newest edit below each: one since the server started, or that of
// a stored chunk. Memory: an entry for each chunk that is stored or was edited since the start, and
// for each tile above one of them.
// Threads: any. The mutex is a leaf and is held for short times only.
#pragma once
#include <cstddef>
#include <mutex>
#include <span>
#include <utility>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "server/interest/chunk_hash_map.hpp"

namespace runstone {

class TileLedger {
 public:
  /// Reports that edit `seq` touched these chunks, or that edits up to it did. A server reports
  /// each commit, and at its start the edits that are in no snapshot. Cost: one look-up a chunk,
  /// and a few instructions for each tile above that the same edit did not reach yet.
  void edited(std::span<const ChunkCoord> chunks, Sequence seq);
  /// Reports touched chunks by their keys, of level of detail 0.
  void edited(std::span<const ChunkKey> chunks, Sequence seq);
  /// Reports touched chunks as edited() unless another thread uses the ledger at the moment; then
  /// it returns false and does nothing. A thread that must not wait calls it: threads of low
  /// priority use the ledger, too.
  bool try_edited(std::span<const ChunkKey> chunks, Sequence seq);
  /// Reports chunks that the store has rows for, with their versions. Keys of tiles are
  /// ignored.
  void stored(std::span<const std::pair<ChunkKey, Version>> chunks);

  /// Returns the newest edit below a tile, or 0 if there is none. Edits of stored chunks count once
  /// stored() got them.
  Sequence newest_edit(const ChunkKey& tile) const;
  /// Returns true if a chunk below the tile, or the chunk itself at level 0, is stored or was
  /// edited. It is complete once stored() got all chunks of the store.
  bool is_stored_or_edited(const ChunkKey& tile) const;

 private:
  /// The entry of a chunk or a tile. Invariant: no edit of `above` is older than the newest of this
  /// one.
  struct Entry {
    Sequence newest_edit = 0;
    Entry* above = nullptr;  // null: of level kTileLevelMax
  };
  void edited(ChunkCoord chunk, Sequence seq);
  /// Returns the entry of a chunk, which is made first, with all above it, if there is none.
  Entry& entry_of(ChunkCoord chunk);

  mutable std::mutex mutex_;
  ChunkHashMap<Entry> entries_;  // values keep their address
};

}  // namespace runstone
