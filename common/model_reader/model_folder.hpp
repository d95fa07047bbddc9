// ModelFolder: the folder of a file that is read, and the only one whose files may be opened. Names of
// further files stand in the file, so they are hostile.
// Thread: one. Calls block on the disk.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "common/core/result.hpp"

namespace runstone {

/// A file that is open for reading, closed with this object.
class OpenedFile {
 public:
  OpenedFile(int descriptor, std::uint64_t bytes) : descriptor_(descriptor), bytes_(bytes) {}
  OpenedFile(OpenedFile&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)), bytes_(other.bytes_) {}
  OpenedFile& operator=(OpenedFile&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~OpenedFile();

  std::uint64_t bytes() const { return bytes_; }
  /// Reads up to `count` bytes from `offset`. Returns their number: fewer than `count` at the end of
  /// the file and after a failure of the disk.
  std::size_t read(void* to, std::size_t count, std::uint64_t offset) const;

 private:
  int descriptor_;
  std::uint64_t bytes_;
};

class ModelFolder {
 public:
  /// Opens the folder that has `file`. Symbolic links at the end of `file` are followed, because the
  /// user named it: the folder is that of the file to which they lead. The error is one line that does
  /// not name the file.
  static Result<ModelFolder, std::string> of_file(const std::string& file);
  ModelFolder(ModelFolder&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)), name_(std::move(other.name_)) {}
  ModelFolder& operator=(ModelFolder&&) = delete;
  ~ModelFolder();

  /// Returns the name of the file within the folder.
  const std::string& name() const { return name_; }
  /// Lets the kernel refuse this process every other folder (Landlock, Linux 5.13). Returns false if
  /// the kernel has no Landlock. Requires limit_process().
  bool confine_process() const;

  enum class Refusal : std::uint8_t { outside, missing, not_a_file, unreadable };
  /// Opens a regular file below the folder. A path is relative to it, and '\\' is '/'. Refused are
  ///   - absolute paths, addresses such as file:///x, and paths whose ".." lead out of the folder;
  ///   - symbolic links that lead out of it (without openat2() of Linux 5.6: all of them);
  ///   - folders, devices, pipes and sockets. None of them is opened.
  Result<OpenedFile, Refusal> open(std::string_view path) const;
  /// Returns the rest of the sentence "the file refers to x, which ...".
  static const char* words(Refusal refusal);

 private:
  ModelFolder(int descriptor, std::string name) : descriptor_(descriptor), name_(std::move(name)) {}

  int descriptor_;
  std::string name_;
};

/// Returns the path without ".", ".." and double slashes. Returns an empty text if the path is empty,
/// absolute or an address, or leads out of the folder from which it starts.
std::string path_within(std::string_view path);

}  // namespace runstone
