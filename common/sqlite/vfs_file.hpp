// sql::VfsFile: a small file beside a database that is no database itself. It is read and written
// through the same SQLite VFS as the database, so the VFS of a test simulates the failures of its
// disk too.
// Threads: one thread at a time uses a VfsFile.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "common/core/bytes.hpp"
#include "common/sql/sql_error.hpp"

namespace runstone::sql {

class VfsFile {
 public:
  enum class Mode {
    read,
    write  // makes the file if it does not exist
  };

  /// Opens a file. `vfs` is the name of an SQLite VFS; an empty name means the default one.
  static Result<VfsFile> open(const std::string& file, Mode mode, const std::string& vfs);
  VfsFile(VfsFile&&) noexcept;
  VfsFile& operator=(VfsFile&&) noexcept;
  ~VfsFile();

  /// Fills `out` with the bytes at `offset`. Bytes behind the end of the file are 0.
  Result<void> read(std::uint64_t offset, std::span<std::uint8_t> out);
  /// Writes bytes in place. They may be lost in a power failure until sync() has returned.
  Result<void> write(std::uint64_t offset, ByteView bytes);
  /// Returns when all written bytes, and the name of a new file, are on disk.
  Result<void> sync();

 private:
  struct Handle;
  explicit VfsFile(std::unique_ptr<Handle> handle);
  std::unique_ptr<Handle> handle_;
};

}  // namespace runstone::sql
