// FileWriter: writes a file at a path that a user gave. Symbolic links are followed and stay.
// Thread: one. Calls block on the disk.
#pragma once
#include <sys/types.h>

#include <string>
#include <utility>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

class FileWriter {
 public:
  /// Writes to a new file beside `file`, which replaces it in finish(). So after a crash the old
  /// file or the new one is there, complete. The new file has the permissions `mode` without those
  /// that the umask of the process takes away and those that an existing file does not give. The
  /// error is that of the system: "Permission denied".
  static Result<FileWriter, std::string> replace(const std::string& file, mode_t mode);
  /// Writes to what is at `file` now: a device, a pipe, or a descriptor of this process such as
  /// /dev/stdout. Fails instead of waiting if nobody reads a named pipe.
  static Result<FileWriter, std::string> in_place(const std::string& file);

  FileWriter(FileWriter&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)),
        file_(std::move(other.file_)),
        fresh_(std::exchange(other.fresh_, {})),
        error_(std::move(other.error_)) {}
  FileWriter& operator=(FileWriter&&) = delete;
  /// Without finish() the old file stays, and the new one is removed.
  ~FileWriter();

  /// Returns false if the bytes could not be written. finish() then fails with the reason.
  bool write(ByteView bytes);
  bool write(std::string_view text);
  /// Returns why write() has failed, as the system says it; empty if it has not.
  const std::string& error() const { return error_; }
  /// Completes the file. If it replaces another one, it is on disk on return, with its name. The
  /// error is that of the system.
  Result<void, std::string> finish();

 private:
  FileWriter(int descriptor, std::string file, std::string fresh)
      : descriptor_(descriptor), file_(std::move(file)), fresh_(std::move(fresh)) {}

  int descriptor_;     // -1 when it is closed
  std::string file_;   // without symbolic links at its end
  std::string fresh_;  // empty in place, and after finish()
  std::string error_;  // of the first write that failed
};

/// Returns true for /dev/stdout and the other names of a descriptor of this process.
bool is_own_descriptor(const std::string& file);
/// Puts the name of a renamed file on disk. Does nothing on a file system that cannot do this. Blocks
/// on the disk.
void sync_folder_of(const std::string& file);
/// Returns the path to which the symbolic links at the end of `path` lead. The path need not exist.
std::string without_links(const std::string& path);

}  // namespace runstone
