// ChunkSource: where chunks come from that are not in memory: newest snapshot, else base, else the generator.
// Threads: load() from any thread; it blocks on the disk, so workers call it. Each caller borrows a reader of
// its own from a pool.
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
  ChunkSource(std::string folder, const Generator& generator)
      : folder_(std::move(folder)), generator_(generator) {}

  /// A chunk as it stands on disk, in its cheapest axis order, with its digest; an error names file, table
  /// and row.
  StoreResult<Chunk> load(const ChunkKey& key);
  /// Lends a reader to `use`, which alone has it for that long.
  StoreResult<void> with_reader(const std::function<void(WorldReader&)>& use);

 private:
  StoreResult<std::unique_ptr<WorldReader>> borrow();
  void give_back(std::unique_ptr<WorldReader> reader);
  StoreResult<Chunk> load(ChunkReader& reader, const ChunkKey& key) const;

  const std::string folder_;
  const Generator& generator_;
  std::mutex mutex_;  // a leaf: guards the pool
  std::vector<std::unique_ptr<WorldReader>> idle_;
};

}  // namespace runstone
