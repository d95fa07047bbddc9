// PartialFolder: a new folder that has its name only when it is complete. Until then it is called
// NAME.partial and holds the file `partial.lock`, which its writer locks. So whatever interrupts
// the writer, a kill and a power failure included, no incomplete folder looks like a finished one.
// Threads: one thread at a time.
#pragma once
#include <iosfwd>
#include <string>
#include <utility>

#include "common/core/result.hpp"
#include "common/os/file_lock.hpp"

namespace runstone {

class PartialFolder {
 public:
  /// Makes `target`.partial with mode 0700. Removes an older one that an interrupted program left,
  /// and prints one line about it to `out`. Fails if
  ///   - `target` or `target`.partial is a symbolic link;
  ///   - `target` exists and is no empty folder;
  ///   - the parent folder does not exist or cannot be written;
  ///   - another program writes `target`.partial, or it is something else than an interrupted
  ///     folder.
  /// The error is one line.
  static Result<PartialFolder, std::string> make(const std::string& target, std::ostream& out);
  PartialFolder(PartialFolder&& other) noexcept
      : target_(std::move(other.target_)),
        path_(std::exchange(other.path_, {})),
        lock_(std::move(other.lock_)) {}
  PartialFolder& operator=(PartialFolder&&) = delete;
  /// Removes the folder unless finish() succeeded.
  ~PartialFolder();

  const std::string& path() const { return path_; }
  /// Gives the folder its name. Its files, its name and its parent are on disk on return. Requires
  /// that no file in it is open for writing.
  Result<void, std::string> finish();

 private:
  PartialFolder(std::string target, std::string path, FileLock lock)
      : target_(std::move(target)), path_(std::move(path)), lock_(std::move(lock)) {}
  std::string target_, path_;  // path_ is empty if there is nothing to remove
  FileLock lock_;
};

/// Returns the absolute name of a folder without "." and "..", and without a slash at the end. The
/// folder need not exist. Symbolic links in its parents are resolved, the folder itself is not.
std::string resolved_name(const std::string& folder);

}  // namespace runstone
