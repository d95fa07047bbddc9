// LoadRetries: the chunks whose load failed for a reason that may pass, such as too many open
// files, and when each is loaded again. The pause doubles from one second to 32. Bound: the loads
// that are under way. Thread: the world strand.
#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"

namespace runstone {

class LoadRetries {
 public:
  /// Notes that a load failed. Returns the pause until the next one, or nullopt after the seventh
  /// failure in a row: the chunk is then not loaded again, and forgotten here.
  std::optional<TimeUs> failed(const ChunkKey& key, TimeUs now_us);
  /// Forgets the failures of a chunk.
  void ended(const ChunkKey& key) { failures_.erase(key); }
  /// Returns the chunks to load now, ascending, each once until it fails again.
  std::vector<ChunkKey> take_due(TimeUs now_us);
  /// Ends every pause now, and lets the next failure of each of these chunks be its last.
  void hurry();
  std::size_t size() const { return failures_.size(); }

 private:
  struct Failure {
    unsigned count = 0;
    std::optional<TimeUs> due_us;  // nullopt: a load is under way
  };
  std::map<ChunkKey, Failure> failures_;
};

}  // namespace runstone
