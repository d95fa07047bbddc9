#include "common/sqlite/vfs_file.hpp"

#include <sqlite3.h>

#include <cerrno>
#include <utility>
#include <vector>

#include "common/sqlite/sqlite_connection.hpp"

namespace runstone::sql {

/// SQLite's data of an open file.
struct VfsFile::Handle {
  Handle(const std::string& file, int bytes)
      : name(file + '\0'),  // a VFS may expect two zero bytes at the end of a name
        memory(static_cast<std::size_t>(bytes) / sizeof(std::max_align_t) + 1) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (get()->pMethods != nullptr) get()->pMethods->xClose(get());
  }
  sqlite3_file* get() { return reinterpret_cast<sqlite3_file*>(memory.data()); }

  std::string name;  // the VFS keeps a pointer to it
  std::vector<std::max_align_t> memory;
};

namespace {

Unexpected<Error> file_failure(const std::string& name, const char* verb, int code, int system) {
  const bool is_full = (code & 0xff) == SQLITE_FULL;
  return {Error{
      is_full ? Error::Kind::full : Error::Kind::io, name.c_str(),
      with_system_error(std::string("cannot be ") + verb + ": " + sqlite3_errstr(code), system)}};
}

}  // namespace

VfsFile::VfsFile(std::unique_ptr<Handle> handle) : handle_(std::move(handle)) {}
VfsFile::VfsFile(VfsFile&&) noexcept = default;
VfsFile& VfsFile::operator=(VfsFile&&) noexcept = default;
VfsFile::~VfsFile() = default;

Result<VfsFile> VfsFile::open(const std::string& file, Mode mode, const std::string& vfs) {
  sqlite3_vfs* system = sqlite3_vfs_find(vfs.empty() ? nullptr : vfs.c_str());
  if (system == nullptr)
    return failure(Error{Error::Kind::io, file, "no SQLite VFS is called " + vfs});
  // A VFS must be told the type of each file. SQLite has no type for a file such as this one. We name
  // the type of super-journals, because a VFS takes no lock for them, and syncs the name of a new one
  // together with its first sync.
  const int flags =
      SQLITE_OPEN_SUPER_JOURNAL |
      (mode == Mode::read ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  auto handle = std::make_unique<Handle>(file, system->szOsFile);
  int flags_given = 0;
  errno = 0;
  const int code = system->xOpen(system, handle->name.c_str(), handle->get(), flags, &flags_given);
  const int system_error = errno;
  if (code != SQLITE_OK) {
    if (mode == Mode::write && system_error == ENOENT)
      return failure(Error{Error::Kind::io, file, why_not_made("cannot be made", system, file)});
    return file_failure(handle->name, "opened", code, system_error);
  }
  // A VFS opens a file for reading that it may not write.
  if (mode == Mode::write && (flags_given & SQLITE_OPEN_READONLY) != 0) {
    return failure(Error{Error::Kind::io, file, why_read_only(system_error)});
  }
  return VfsFile(std::move(handle));
}

Result<void> VfsFile::read(std::uint64_t offset, std::span<std::uint8_t> out) {
  const int code = handle_->get()->pMethods->xRead(
      handle_->get(), out.data(), static_cast<int>(out.size()), static_cast<sqlite3_int64>(offset));
  // A short read fills the rest with zeros.
  if (code != SQLITE_OK && code != SQLITE_IOERR_SHORT_READ)
    return file_failure(handle_->name, "read", code, last_error_of(handle_->get()));
  return {};
}

Result<void> VfsFile::write(std::uint64_t offset, ByteView bytes) {
  const int code =
      handle_->get()->pMethods->xWrite(handle_->get(), bytes.data(), static_cast<int>(bytes.size()),
                                       static_cast<sqlite3_int64>(offset));
  if (code != SQLITE_OK)
    return file_failure(handle_->name, "written", code, last_error_of(handle_->get()));
  return {};
}

Result<void> VfsFile::sync() {
  const int code = handle_->get()->pMethods->xSync(handle_->get(), SQLITE_SYNC_NORMAL);
  if (code != SQLITE_OK)
    return file_failure(handle_->name, "synced", code, last_error_of(handle_->get()));
  return {};
}

}  // namespace runstone::sql
