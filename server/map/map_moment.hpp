// MapMoment: the world of one moment as the map needs it: its chunks, and the versions of all
// chunks and tiles. The present is a moment that advances with the log.
// Threads: open() and advance() by one thread while no other one uses the object; reader() belongs
// to that thread. The other functions by any thread, each with a reader and a scratch of its own.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "server/history/world_at.hpp"
#include "server/map/ground_index.hpp"

namespace runstone {

class MapMoment {
 public:
  using EachRecord = std::function<void(const EditRecord&)>;

  /// Opens the world after edit `at`. The generator must outlive the object. Fails as
  /// WorldAt::open(), and (bad_request) if more than Moments::kEditsMax edits lie between the
  /// moment and the stored one before it.
  static StoreResult<std::unique_ptr<MapMoment>> open(const std::string& place,
                                                      const Generator& generator, Sequence at,
                                                      const WorldAt::Progress& progress = {});

  /// Moves to a later edit. `each` is called for every record between. After a failure the object
  /// may not be used any more. Fails as WorldAt::advance(), and (bad_request) if the log no longer
  /// has the edit at which the object stands, because another log has replaced it.
  StoreResult<void> advance(Sequence at, const EachRecord& each,
                            const WorldAt::Progress& progress = {});

  Sequence at() const { return world_->at(); }
  const LogEnd& end() const { return world_->end(); }
  /// Returns the number of edits that are in memory.
  Sequence edits_kept() const { return world_->at() - world_->stored_at(); }
  const GroundIndex& ground() const { return ground_; }
  const WorldMeta& meta() const { return reader_->meta(); }
  WorldReader& reader() { return *reader_; }

  /// Returns a chunk that has an entry in ground(). Fails as WorldAt::chunk().
  StoreResult<RunChunk> voxels(const ChunkKey& key, WorldReader& reader,
                               ReplayScratch& scratch) const {
    return world_->voxels(key, reader, scratch);
  }

 private:
  explicit MapMoment(std::unique_ptr<WorldReader> reader) : reader_(std::move(reader)) {}

  std::unique_ptr<WorldReader> reader_;
  std::unique_ptr<WorldAt> world_;
  GroundIndex ground_;
};

}  // namespace runstone
