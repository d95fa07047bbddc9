// FolderLock: one process at a time writes a cache folder. Held by an open file, so a process that is killed lets go.
#pragma once
#include <optional>
#include <string>
#include <utility>

namespace runstone {

class FolderLock {
 public:
  /// Nothing if another process (or another lock of this one) holds it, or the file cannot be made; errno says which:
  /// EWOULDBLOCK for the former.
  static std::optional<FolderLock> take(const std::string& file);
  FolderLock(FolderLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  FolderLock& operator=(FolderLock&&) = delete;
  ~FolderLock();

 private:
  explicit FolderLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

}  // namespace runstone
