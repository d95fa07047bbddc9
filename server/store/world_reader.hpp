// WorldReader: everything that can be read of a world. A function that needs less takes one of the
// smaller interfaces.
#pragma once
#include <optional>

#include "server/store/chunk_reader.hpp"
#include "server/store/keyframe_reader.hpp"
#include "server/store/log_reader.hpp"
#include "server/store/player_reader.hpp"

namespace runstone {

class WorldReader : public LogReader,
                    public ChunkReader,
                    public KeyframeReader,
                    public PlayerReader {
 public:
  /// Returns the error if the world, when it was opened, lacked edits that had been durable, or if
  /// that cannot be known. Returns nullopt if the log is whole.
  virtual const std::optional<StoreError>& loss() const = 0;
  /// Returns false if the connection with the database was lost: every read fails from then on. A loss is
  /// known after the first read that fails.
  virtual bool is_usable() const { return true; }
  /// Begins reads that see one moment of the world until end_reads(). Each of them costs less,
  /// because it takes and leaves no lock. Few at a time: meanwhile a server that runs the world
  /// cannot move its write-ahead log into the database. Do not nest them, and write nothing before
  /// end_reads().
  virtual StoreResult<void> begin_reads() = 0;
  virtual StoreResult<void> end_reads() = 0;
  /// Reads and verifies every row of every table but `tile`, which is a cache, and runs the
  /// database's own check. It is slow, and meant for audits. A loss() is no error of a row.
  virtual StoreResult<void> check() = 0;
};

}  // namespace runstone
