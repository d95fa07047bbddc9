#include "tests/support/sql/fault_vfs.hpp"

#include <fcntl.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <mutex>

#include "common/core/assert.hpp"

namespace runstone::test {
namespace {

enum class Access { reads, writes, opens_to_write, makes_file };

/// The fault that a test has ordered.
struct Fault {
  std::uint64_t calls_left = 0;  // until the first one that fails
  int system_error = 0;          // 0: none
  FaultVfs::Lasts lasts = FaultVfs::Lasts::once;
  bool has_failed = false;

  bool can_strike(Access access) const {
    switch (system_error) {
      case 0:
        return false;
      case EIO:
        return true;
      case EROFS:
        return access != Access::reads;
      case EFBIG:
        return access == Access::writes;
      default:
        return access == Access::writes || access == Access::makes_file;
    }
  }
  /// Returns true, with errno set, if this call fails.
  bool strikes(Access access) {
    if (!can_strike(access)) return false;
    if (calls_left > 1) {
      --calls_left;
      return false;
    }
    if (has_failed && lasts == FaultVfs::Lasts::once) return false;
    has_failed = true;
    errno = system_error;
    return true;
  }
};

std::mutex fault_mutex;
Fault fault;  // guarded by fault_mutex

bool strikes(Access access) {
  const std::lock_guard guard(fault_mutex);
  return fault.strikes(access);
}

sqlite3_vfs* unix_vfs = nullptr;

/// The system's calls before this VFS replaced them.
struct SystemCalls {
  int (*open)(const char*, int, int);
  int (*stat)(const char*, struct stat*);
  int (*fstat)(int, struct stat*);
  int (*ftruncate)(int, off_t);
  int (*unlink)(const char*);
  ssize_t (*read)(int, void*, size_t);
  ssize_t (*pread)(int, void*, size_t, off_t);
  ssize_t (*pread64)(int, void*, size_t, off64_t);
  ssize_t (*write)(int, const void*, size_t);
  ssize_t (*pwrite)(int, const void*, size_t, off_t);
  ssize_t (*pwrite64)(int, const void*, size_t, off64_t);
};
SystemCalls calls;

/// A call of the system that may fail instead.
template <auto Member, Access kAccess>
struct Faulty;
template <class Return, class... Args, Return (*SystemCalls::*Member)(Args...), Access kAccess>
struct Faulty<Member, kAccess> {
  static Return call(Args... args) {
    if (strikes(kAccess)) return -1;
    return (calls.*Member)(args...);
  }
};

int faulty_open(const char* path, int flags, int mode) {
  Access access = Access::reads;
  if ((flags & O_ACCMODE) != O_RDONLY) access = Access::opens_to_write;
  if ((flags & O_CREAT) != 0 && ::access(path, F_OK) != 0) access = Access::makes_file;
  if (strikes(access)) return -1;
  return calls.open(path, flags, mode);
}

template <class Function>
void replace(const char* name, Function*& before, Function* now) {
  const auto found = unix_vfs->xGetSystemCall(unix_vfs, name);
  if (found == nullptr) return;  // this build of SQLite has another call for it
  before = reinterpret_cast<Function*>(found);
  const int set =
      unix_vfs->xSetSystemCall(unix_vfs, name, reinterpret_cast<sqlite3_syscall_ptr>(now));
  RUNSTONE_ASSERT(set == SQLITE_OK);
}

/// SQLite's data of an open file. The data of the system's VFS follow it.
struct FaultFile {
  sqlite3_file base;
  int sync_error;  // of the last sync that failed
};
constexpr std::size_t kFaultFileBytes = (sizeof(FaultFile) + alignof(std::max_align_t) - 1) /
                                        alignof(std::max_align_t) * alignof(std::max_align_t);

FaultFile& fault_file(sqlite3_file* file) { return *reinterpret_cast<FaultFile*>(file); }
sqlite3_file* unix_file(sqlite3_file* file) {
  return reinterpret_cast<sqlite3_file*>(reinterpret_cast<char*>(file) + kFaultFileBytes);
}

/// A call that the system's VFS carries out.
template <auto Member>
struct PassOn;
template <class... Args, int (*sqlite3_io_methods::*Member)(sqlite3_file*, Args...)>
struct PassOn<Member> {
  static int call(sqlite3_file* file, Args... args) {
    sqlite3_file* real = unix_file(file);
    return (real->pMethods->*Member)(real, args...);
  }
};

int faulty_sync(sqlite3_file* file, int /*flags*/) {
  if (!strikes(Access::writes)) return SQLITE_OK;
  fault_file(file).sync_error = errno;
  return SQLITE_IOERR_FSYNC;
}

int faulty_control(sqlite3_file* file, int operation, void* argument) {
  if (operation == SQLITE_FCNTL_LAST_ERRNO && fault_file(file).sync_error != 0) {
    *static_cast<int*>(argument) = fault_file(file).sync_error;
    return SQLITE_OK;
  }
  return PassOn<&sqlite3_io_methods::xFileControl>::call(file, operation, argument);
}

void pass_on_shm_barrier(sqlite3_file* file) {
  unix_file(file)->pMethods->xShmBarrier(unix_file(file));
}

constexpr sqlite3_io_methods kFaultMethods = {
    2,
    PassOn<&sqlite3_io_methods::xClose>::call,
    PassOn<&sqlite3_io_methods::xRead>::call,
    PassOn<&sqlite3_io_methods::xWrite>::call,
    PassOn<&sqlite3_io_methods::xTruncate>::call,
    faulty_sync,
    PassOn<&sqlite3_io_methods::xFileSize>::call,
    PassOn<&sqlite3_io_methods::xLock>::call,
    PassOn<&sqlite3_io_methods::xUnlock>::call,
    PassOn<&sqlite3_io_methods::xCheckReservedLock>::call,
    faulty_control,
    PassOn<&sqlite3_io_methods::xSectorSize>::call,
    PassOn<&sqlite3_io_methods::xDeviceCharacteristics>::call,
    PassOn<&sqlite3_io_methods::xShmMap>::call,
    PassOn<&sqlite3_io_methods::xShmLock>::call,
    pass_on_shm_barrier,
    PassOn<&sqlite3_io_methods::xShmUnmap>::call,
    nullptr,
    nullptr,
};

int faulty_open_file(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags,
                     int* out_flags) {
  sqlite3_file* real = unix_file(file);
  const int code = unix_vfs->xOpen(unix_vfs, name, real, flags, out_flags);
  fault_file(file).sync_error = 0;
  file->pMethods = real->pMethods == nullptr ? nullptr : &kFaultMethods;
  return code;
}

}  // namespace

FaultVfs::FaultVfs()
    : system_(sqlite3_vfs_find("unix")), vfs_(std::make_unique<sqlite3_vfs>(*system_)) {
  RUNSTONE_ASSERT(unix_vfs == nullptr);
  unix_vfs = system_;
  fault = {};
  constexpr auto kReads = Access::reads, kWrites = Access::writes;
  replace("open", calls.open, faulty_open);
  replace("stat", calls.stat, Faulty<&SystemCalls::stat, kReads>::call);
  replace("fstat", calls.fstat, Faulty<&SystemCalls::fstat, kReads>::call);
  replace("ftruncate", calls.ftruncate, Faulty<&SystemCalls::ftruncate, kWrites>::call);
  replace("unlink", calls.unlink, Faulty<&SystemCalls::unlink, kWrites>::call);
  replace("read", calls.read, Faulty<&SystemCalls::read, kReads>::call);
  replace("pread", calls.pread, Faulty<&SystemCalls::pread, kReads>::call);
  replace("pread64", calls.pread64, Faulty<&SystemCalls::pread64, kReads>::call);
  replace("write", calls.write, Faulty<&SystemCalls::write, kWrites>::call);
  replace("pwrite", calls.pwrite, Faulty<&SystemCalls::pwrite, kWrites>::call);
  replace("pwrite64", calls.pwrite64, Faulty<&SystemCalls::pwrite64, kWrites>::call);
  vfs_->zName = name();
  vfs_->szOsFile += static_cast<int>(kFaultFileBytes);
  vfs_->pNext = nullptr;
  vfs_->xOpen = faulty_open_file;
  sqlite3_vfs_register(vfs_.get(), 0);
}

FaultVfs::~FaultVfs() {
  heal();
  sqlite3_vfs_unregister(vfs_.get());
  system_->xSetSystemCall(system_, nullptr, nullptr);  // restores all
  unix_vfs = nullptr;
}

void FaultVfs::fail(std::uint64_t call, int system_error, Lasts lasts) {
  const std::lock_guard guard(fault_mutex);
  fault = {call, system_error, lasts, false};
}
void FaultVfs::heal() {
  const std::lock_guard guard(fault_mutex);
  fault.system_error = 0;
}
bool FaultVfs::has_failed() const {
  const std::lock_guard guard(fault_mutex);
  return fault.has_failed;
}

}  // namespace runstone::test
