// ChunkSource: loads chunks that are not in memory. It reads the newest snapshot. If there is none,
// it reads the base chunk. If there is none either, it generates the chunk. It keeps a pool of
// readers of the world. Threads: any. Calls block on the disk, so workers make them. Each
// call uses a reader of its own.
#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "common/generate/generator.hpp"
#include "server/store/store.hpp"

namespace runstone {

class ChunkSource {
 public:
  /// `generator` must outlive the source.
  ChunkSource(std::string place, const Generator& generator)
      : place_(std::move(place)), generator_(generator) {}

  /// Returns the chunk on disk, in its cheapest axis order, with its digest. The error names file,
  /// table and row.
  StoreResult<Chunk> load(const ChunkKey& key);
  /// Calls `use` with a reader that nobody else uses meanwhile. Fails if no reader can be opened;
  /// `use` is not called then.
  StoreResult<void> with_reader(const std::function<void(WorldReader&)>& use);

 private:
  StoreResult<std::unique_ptr<WorldReader>> borrow();
  void give_back(std::unique_ptr<WorldReader> reader);
  StoreResult<Chunk> load(ChunkReader& reader, const ChunkKey& key) const;

  const std::string place_;
  const Generator& generator_;
  std::mutex mutex_;  // a leaf: guards the pool
  std::vector<std::unique_ptr<WorldReader>> idle_;
};

}  // namespace runstone
