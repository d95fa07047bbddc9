// FileLock: an advisory lock on a file. At most one process writes a folder: the process that holds
// the lock of a file in it. The lock belongs to the open file, so the end of the process releases
// it, however it ends. Locks on other files, such as those of a database in the same folder, are
// not affected.
#pragma once
#include <string>
#include <utility>

#include "common/core/result.hpp"

namespace runstone {

struct FileLockError {
  // true: another lock holds the file; false: the file cannot be opened or locked
  bool is_held = false;
  std::string what;  // the system's message
};

class FileLock {
 public:
  /// Takes the lock without waiting. Makes the file if it does not exist. Fails if another lock
  /// holds it, in this process too, or if the file cannot be written.
  static Result<FileLock, FileLockError> take(const std::string& file);

  /// Makes an object that holds no lock.
  FileLock() = default;
  FileLock(FileLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  FileLock& operator=(FileLock&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  /// Releases the lock. The file stays: if it were removed, two processes could lock two files of
  /// the same name.
  ~FileLock();

 private:
  explicit FileLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_ = -1;
};

}  // namespace runstone
