#include "tests/support/sql/full_disk_vfs.hpp"

#include <sqlite3.h>

#include <atomic>

#include "common/core/assert.hpp"

namespace runstone::test {
namespace {

std::atomic<bool> is_disk_full{false};
sqlite3_vfs* system_vfs = nullptr;

/// SQLite's data of an open file. The data of the system's VFS follow it.
struct FullDiskFile {
  sqlite3_file base;
  void* alignment;
};

sqlite3_file* system_file(sqlite3_file* file) {
  return reinterpret_cast<sqlite3_file*>(reinterpret_cast<FullDiskFile*>(file) + 1);
}

/// A call that the system's VFS carries out.
template <auto Member>
struct Forward;
template <class... Args, int (*sqlite3_io_methods::*Member)(sqlite3_file*, Args...)>
struct Forward<Member> {
  static int call(sqlite3_file* file, Args... args) {
    sqlite3_file* real = system_file(file);
    return (real->pMethods->*Member)(real, args...);
  }
};

int full_disk_write(sqlite3_file* file, const void* data, int bytes, sqlite3_int64 offset) {
  if (is_disk_full) return SQLITE_FULL;
  return Forward<&sqlite3_io_methods::xWrite>::call(file, data, bytes, offset);
}

void full_disk_shm_barrier(sqlite3_file* file) {
  system_file(file)->pMethods->xShmBarrier(system_file(file));
}

constexpr sqlite3_io_methods kFullDiskMethods = {
    3,
    Forward<&sqlite3_io_methods::xClose>::call,
    Forward<&sqlite3_io_methods::xRead>::call,
    full_disk_write,
    Forward<&sqlite3_io_methods::xTruncate>::call,
    Forward<&sqlite3_io_methods::xSync>::call,
    Forward<&sqlite3_io_methods::xFileSize>::call,
    Forward<&sqlite3_io_methods::xLock>::call,
    Forward<&sqlite3_io_methods::xUnlock>::call,
    Forward<&sqlite3_io_methods::xCheckReservedLock>::call,
    Forward<&sqlite3_io_methods::xFileControl>::call,
    Forward<&sqlite3_io_methods::xSectorSize>::call,
    Forward<&sqlite3_io_methods::xDeviceCharacteristics>::call,
    Forward<&sqlite3_io_methods::xShmMap>::call,
    Forward<&sqlite3_io_methods::xShmLock>::call,
    full_disk_shm_barrier,
    Forward<&sqlite3_io_methods::xShmUnmap>::call,
    Forward<&sqlite3_io_methods::xFetch>::call,
    Forward<&sqlite3_io_methods::xUnfetch>::call,
};

int full_disk_open(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags, int* out_flags) {
  sqlite3_file* real = system_file(file);
  const int code = system_vfs->xOpen(system_vfs, name, real, flags, out_flags);
  file->pMethods = real->pMethods == nullptr ? nullptr : &kFullDiskMethods;
  return code;
}

}  // namespace

FullDiskVfs::FullDiskVfs()
    : system_(sqlite3_vfs_find(nullptr)), vfs_(std::make_unique<sqlite3_vfs>(*system_)) {
  RUNSTONE_ASSERT(system_vfs == nullptr);
  system_vfs = system_;
  vfs_->zName = "runstone-full-disk";
  vfs_->szOsFile += static_cast<int>(sizeof(FullDiskFile));
  vfs_->pNext = nullptr;
  vfs_->xOpen = full_disk_open;
  sqlite3_vfs_register(vfs_.get(), 1);
}

FullDiskVfs::~FullDiskVfs() {
  make_room();
  sqlite3_vfs_unregister(vfs_.get());
  sqlite3_vfs_register(system_, 1);
  system_vfs = nullptr;
}

void FullDiskVfs::fill() { is_disk_full = true; }
void FullDiskVfs::make_room() { is_disk_full = false; }

}  // namespace runstone::test
