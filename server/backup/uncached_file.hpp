// UncachedFile: keeps a file that SQLite writes out of the page cache. The pages of a backup are
// read once at most, so they must not displace those of the world that is being played. Written
// bytes go to the disk in small parts: the kernel would otherwise collect them, and write so many
// at once that the fsync of a commit waits for them.
// Threads: one thread at a time.
#pragma once
#include <cstdint>
#include <string>
#include <utility>

#include "common/core/result.hpp"

namespace runstone {

class UncachedFile {
 public:
  /// Makes an empty file for its owner only. Fails if the name exists, also as a symbolic link. The
  /// error begins with the name of the file.
  static Result<UncachedFile, std::string> make(const std::string& file);
  UncachedFile(UncachedFile&& other) noexcept
      : file_(std::move(other.file_)), descriptor_(std::exchange(other.descriptor_, -1)) {}
  UncachedFile& operator=(UncachedFile&&) = delete;
  /// Closes the file. This ends the locks of this process on it, so SQLite's connections to the
  /// file must be closed before.
  ~UncachedFile();

  /// Reserves disk space for `bytes` bytes. The size of the file stays. Fails if the disk has no
  /// room. A file system that cannot reserve space is no failure.
  Result<void, std::string> reserve(std::uint64_t bytes);
  /// Returns when all written bytes are on disk, and drops them from the page cache.
  Result<void, std::string> flush();

 private:
  UncachedFile(std::string file, int descriptor)
      : file_(std::move(file)), descriptor_(descriptor) {}
  std::string file_;
  int descriptor_ = -1;
};

}  // namespace runstone
