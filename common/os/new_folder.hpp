// NewFolder: a folder that a program fills for its user, such as a copy of a world. Whatever
// interrupts the program, a kill and a power failure included, nothing incomplete looks finished.
//   - If there is no folder of that name, the files are written to NAME.partial, which is renamed
//     when it is complete.
//   - If there is an empty one, which may be a mount point, and to which a symbolic link may lead,
//     it is kept with its owner and permissions. The files are written to its folder `.partial` and
//     moved up when they are complete, the file without which the others mean nothing last.
// The folder of unfinished files holds the file `partial.lock`, which its writer locks. One that is
// not locked was interrupted, and the next program that wants the name removes it.
// Threads: one thread at a time.
#pragma once
#include <iosfwd>
#include <string>
#include <utility>

#include "common/core/result.hpp"
#include "common/os/file_lock.hpp"

namespace runstone {

class NewFolder {
 public:
  /// Fails unless make() can make a folder of this name now. Changes nothing. The error is one line.
  static Result<void, std::string> check(const std::string& target);
  /// Begins to make `target`. Prints a line about an interrupted folder that it removes to `out`.
  /// Fails if
  ///   - `target` exists and is no empty folder (`lost+found` does not count);
  ///   - the parent folder does not exist or cannot be written;
  ///   - another program makes `target`, or something else has the name of its unfinished files.
  /// The error is one line.
  static Result<NewFolder, std::string> make(const std::string& target, std::ostream& out);
  NewFolder(NewFolder&& other) noexcept
      : target_(std::move(other.target_)),
        path_(std::exchange(other.path_, {})),
        is_inside_(other.is_inside_),
        lock_(std::move(other.lock_)) {}
  NewFolder& operator=(NewFolder&&) = delete;
  /// Removes the unfinished files unless finish() succeeded.
  ~NewFolder();

  /// Returns the folder into which the files are written until finish().
  const std::string& path() const { return path_; }
  /// Completes the folder. `last` is the file that comes last. The files, their names and the parent
  /// are on disk on return. Requires that no file in it is open for writing.
  Result<void, std::string> finish(const std::string& last);

 private:
  NewFolder(std::string target, std::string path, bool is_inside, FileLock lock)
      : target_(std::move(target)),
        path_(std::move(path)),
        is_inside_(is_inside),
        lock_(std::move(lock)) {}
  Result<void, std::string> move_up(const std::string& last);
  Result<void, std::string> rename();

  std::string target_, path_;  // path_ is empty if there is nothing to remove
  bool is_inside_;             // path_ lies in target_
  FileLock lock_;
};

/// Returns the absolute name of a folder without "." and "..", and without a slash at the end. The
/// folder need not exist. Symbolic links in its parents are resolved, the folder itself is not.
std::string resolved_name(const std::string& folder);

}  // namespace runstone
