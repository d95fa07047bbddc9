// WriterLock: at most one process writes a world. An advisory lock on a file of its own beside the database,
// so that readers are never in its way, and gone by itself when the process dies.
#pragma once
#include <string>

#include "server/store/store.hpp"

namespace runstone {

class WriterLock {
 public:
  /// Takes FOLDER/world.lock without waiting. A second writer, in this process too, gets Kind::locked; a
  /// folder that cannot be written gets Kind::io. `file` names the world in the error.
  static StoreResult<WriterLock> take(const std::string& folder, const std::string& file);

  /// Holds nothing.
  WriterLock() = default;
  WriterLock(WriterLock&& other) noexcept : descriptor_(other.descriptor_) {
    other.descriptor_ = -1;
  }
  WriterLock& operator=(WriterLock&& other) noexcept;
  ~WriterLock();

 private:
  int descriptor_ = -1;
};

}  // namespace runstone
