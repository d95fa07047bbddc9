#include "tests/support/sql/power_loss_vfs.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <new>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone::test {

namespace {

constexpr int kShmLocks = 8;
static_assert(kShmLocks == SQLITE_SHM_NLOCK);

}  // namespace

struct PowerLossCalls {
  using File = PowerLossVfs::File;
  using Change = PowerLossVfs::Change;

  /// SQLite's data of an open file; `base` must come first.
  struct Handle {
    sqlite3_file base;
    PowerLossVfs* vfs;
    std::shared_ptr<File> file;
    std::string path;
    std::uint64_t generation;
    int lock;
    bool delete_on_close;
    // The next sync is the first of a new journal: SQLite's VFS then syncs the folder.
    bool sync_names;

    bool alive() const { return generation == vfs->generation_ && !vfs->cut_; }
  };

  static Handle& of(sqlite3_file* file) { return *reinterpret_cast<Handle*>(file); }
  static PowerLossVfs& of(sqlite3_vfs* vfs) { return *static_cast<PowerLossVfs*>(vfs->pAppData); }
  static void erase(std::vector<const void*>& from, const void* what) {
    from.erase(std::remove(from.begin(), from.end(), what), from.end());
  }

  /// A call for SQLite that holds the mutex of its VFS.
  template <auto Function>
  struct Locked;
  template <class... Args, int (*Function)(sqlite3_file*, Args...)>
  struct Locked<Function> {
    static int call(sqlite3_file* file, Args... args) {
      const std::lock_guard guard(of(file).vfs->mutex_);
      return Function(file, args...);
    }
  };
  template <class... Args, int (*Function)(sqlite3_vfs*, Args...)>
  struct Locked<Function> {
    static int call(sqlite3_vfs* vfs, Args... args) {
      const std::lock_guard guard(of(vfs).mutex_);
      return Function(vfs, args...);
    }
  };

  static int open(sqlite3_vfs* vfs, const char* name, sqlite3_file* out, int flags,
                  int* out_flags) {
    PowerLossVfs& self = of(vfs);
    out->pMethods = nullptr;
    const std::string path =
        name == nullptr ? "temporary-" + std::to_string(self.operations_) : name;
    auto found = self.live_names_.find(path);
    const bool created = found == self.live_names_.end();
    if (created) {
      if ((flags & SQLITE_OPEN_CREATE) == 0) return SQLITE_CANTOPEN;
      if (self.cut_) return SQLITE_CANTOPEN;
      found = self.live_names_.emplace(path, std::make_shared<File>()).first;
    }
    const bool journal =
        (flags & (SQLITE_OPEN_MAIN_JOURNAL | SQLITE_OPEN_SUPER_JOURNAL | SQLITE_OPEN_WAL)) != 0;
    new (out) Handle{{methods()},
                     &self,
                     found->second,
                     path,
                     self.generation_,
                     SQLITE_LOCK_NONE,
                     (flags & SQLITE_OPEN_DELETEONCLOSE) != 0,
                     created && journal};
    if (out_flags != nullptr) *out_flags = flags;
    return SQLITE_OK;
  }

  static int remove(sqlite3_vfs* vfs, const char* path, int sync_folder) {
    PowerLossVfs& self = of(vfs);
    if (!self.operate()) return SQLITE_IOERR_DELETE;
    if (self.live_names_.erase(path) == 0) return SQLITE_IOERR_DELETE_NOENT;
    if (sync_folder != 0) self.durable_names_ = self.live_names_;
    return SQLITE_OK;
  }

  static int access(sqlite3_vfs* vfs, const char* path, int, int* out) {
    *out = of(vfs).live_names_.contains(path) ? 1 : 0;
    return SQLITE_OK;
  }

  static int full_path(sqlite3_vfs*, const char* path, int bytes, char* out) {
    const std::size_t length = std::strlen(path);
    if (length + 1 > static_cast<std::size_t>(bytes)) return SQLITE_CANTOPEN;
    std::memcpy(out, path, length + 1);
    return SQLITE_OK;
  }

  static int close(sqlite3_file* file) {
    Handle& handle = of(file);
    unlock(file, SQLITE_LOCK_NONE);
    shm_unmap(file, 0);
    if (handle.delete_on_close) handle.vfs->live_names_.erase(handle.path);
    handle.~Handle();
    return SQLITE_OK;
  }

  static int read(sqlite3_file* file, void* out, int bytes, sqlite3_int64 offset) {
    Handle& handle = of(file);
    if (!handle.alive()) return SQLITE_IOERR_READ;
    const Bytes& live = handle.file->live;
    const auto wanted = static_cast<std::size_t>(bytes);
    const std::size_t from = std::min(static_cast<std::size_t>(offset), live.size());
    const std::size_t there = std::min(wanted, live.size() - from);
    if (there > 0) std::memcpy(out, live.data() + from, there);
    if (there == wanted) return SQLITE_OK;
    std::memset(static_cast<char*>(out) + there, 0, wanted - there);
    return SQLITE_IOERR_SHORT_READ;
  }

  static int change(Handle& handle, Change change, int failure) {
    if (!handle.alive()) return failure;
    // The write during which the power fails is incomplete: it is pending like any other.
    const bool powered = handle.vfs->operate();
    PowerLossVfs::apply(change, handle.file->live);
    handle.file->pending.push_back(std::move(change));
    return powered ? SQLITE_OK : failure;
  }

  static int write(sqlite3_file* file, const void* data, int bytes, sqlite3_int64 offset) {
    const PowerLossVfs& vfs = *of(file).vfs;
    if (of(file).alive() && vfs.operations_ >= vfs.full_at_) return SQLITE_FULL;
    const auto* from = static_cast<const std::uint8_t*>(data);
    return change(of(file), {false, static_cast<std::size_t>(offset), Bytes(from, from + bytes)},
                  SQLITE_IOERR_WRITE);
  }

  static int truncate(sqlite3_file* file, sqlite3_int64 size) {
    return change(of(file), {true, static_cast<std::size_t>(size), {}}, SQLITE_IOERR_TRUNCATE);
  }

  static int sync(sqlite3_file* file, int) {
    Handle& handle = of(file);
    if (!handle.alive() || !handle.vfs->operate()) return SQLITE_IOERR_FSYNC;
    if (std::exchange(handle.vfs->fail_sync_, false)) return SQLITE_IOERR_FSYNC;
    ++handle.vfs->syncs_;
    if (handle.vfs->ignore_syncs_) return SQLITE_OK;
    for (const Change& change : handle.file->pending)
      PowerLossVfs::apply(change, handle.file->durable);
    handle.file->pending.clear();
    if (std::exchange(handle.sync_names, false))
      handle.vfs->durable_names_ = handle.vfs->live_names_;
    return SQLITE_OK;
  }

  static int size(sqlite3_file* file, sqlite3_int64* out) {
    *out = static_cast<sqlite3_int64>(of(file).file->live.size());
    return SQLITE_OK;
  }

  static int lock(sqlite3_file* file, int level) {
    Handle& handle = of(file);
    File& state = *handle.file;
    if (handle.lock >= level) return SQLITE_OK;
    const auto held_by_other = [&](const void* holder) {
      return holder != nullptr && holder != &handle;
    };
    if (held_by_other(state.exclusive) || held_by_other(state.pending_lock)) return SQLITE_BUSY;
    if (level == SQLITE_LOCK_SHARED) ++state.readers;
    if (level >= SQLITE_LOCK_RESERVED) {
      if (held_by_other(state.reserved)) return SQLITE_BUSY;
      state.reserved = &handle;
    }
    if (level == SQLITE_LOCK_EXCLUSIVE) {
      state.pending_lock = &handle;
      if (state.readers > 1) return SQLITE_BUSY;
      state.exclusive = &handle;
    }
    handle.lock = level;
    return SQLITE_OK;
  }

  static int unlock(sqlite3_file* file, int level) {
    Handle& handle = of(file);
    File& state = *handle.file;
    for (const void** holder : {&state.exclusive, &state.pending_lock, &state.reserved}) {
      if (*holder == &handle) *holder = nullptr;
    }
    if (level == SQLITE_LOCK_NONE && handle.lock >= SQLITE_LOCK_SHARED) --state.readers;
    handle.lock = std::min(handle.lock, level);
    return SQLITE_OK;
  }

  static int check_reserved(sqlite3_file* file, int* out) {
    *out = of(file).file->reserved != nullptr ? 1 : 0;
    return SQLITE_OK;
  }

  static int control(sqlite3_file*, int, void*) { return SQLITE_NOTFOUND; }
  static int sector_size(sqlite3_file*) { return static_cast<int>(kPowerLossSectorBytes); }
  static int characteristics(sqlite3_file*) { return SQLITE_IOCAP_POWERSAFE_OVERWRITE; }

  static int shm_map(sqlite3_file* file, int region, int bytes, int extend, void volatile** out) {
    Handle& handle = of(file);
    *out = nullptr;
    if (!handle.alive()) return SQLITE_IOERR_SHMMAP;
    auto& regions = handle.file->shared_memory;
    const auto index = static_cast<std::size_t>(region);
    if (index >= regions.size() && extend == 0) return SQLITE_OK;
    while (index >= regions.size())
      regions.push_back(std::make_unique<Bytes>(static_cast<std::size_t>(bytes)));
    *out = regions[index]->data();
    return SQLITE_OK;
  }

  static int shm_lock(sqlite3_file* file, int first, int count, int flags) {
    Handle& handle = of(file);
    File& state = *handle.file;
    if ((flags & SQLITE_SHM_UNLOCK) != 0) {
      for (int i = first; i < first + count; ++i) {
        erase(state.shared_memory_users[i], &handle);
        if (state.shared_memory_users[i].empty()) state.shared_memory_exclusive[i] = false;
      }
      return SQLITE_OK;
    }
    if (!handle.alive()) return SQLITE_IOERR_SHMLOCK;
    const bool exclusive = (flags & SQLITE_SHM_EXCLUSIVE) != 0;
    for (int i = first; i < first + count; ++i) {
      const bool used = !state.shared_memory_users[i].empty();
      if (used && (exclusive || state.shared_memory_exclusive[i])) return SQLITE_BUSY;
    }
    for (int i = first; i < first + count; ++i) {
      state.shared_memory_users[i].push_back(&handle);
      state.shared_memory_exclusive[i] = exclusive;
    }
    return SQLITE_OK;
  }

  static void shm_barrier(sqlite3_file*) { std::atomic_thread_fence(std::memory_order_seq_cst); }

  static int shm_unmap(sqlite3_file* file, int remove_memory) {
    Handle& handle = of(file);
    for (auto& users : handle.file->shared_memory_users) erase(users, &handle);
    if (remove_memory != 0 && handle.alive()) handle.file->shared_memory.clear();
    return SQLITE_OK;
  }

  static const sqlite3_io_methods* methods() {
    static const sqlite3_io_methods table = [] {
      sqlite3_io_methods m{};
      m.iVersion = 2;
      m.xClose = Locked<close>::call;
      m.xRead = Locked<read>::call;
      m.xWrite = Locked<write>::call;
      m.xTruncate = Locked<truncate>::call;
      m.xSync = Locked<sync>::call;
      m.xFileSize = Locked<size>::call;
      m.xLock = Locked<lock>::call;
      m.xUnlock = Locked<unlock>::call;
      m.xCheckReservedLock = Locked<check_reserved>::call;
      m.xFileControl = Locked<control>::call;
      m.xSectorSize = Locked<sector_size>::call;
      m.xDeviceCharacteristics = Locked<characteristics>::call;
      m.xShmMap = Locked<shm_map>::call;
      m.xShmLock = Locked<shm_lock>::call;
      m.xShmBarrier = shm_barrier;
      m.xShmUnmap = Locked<shm_unmap>::call;
      return m;
    }();
    return &table;
  }
};

PowerLossVfs::PowerLossVfs() : vfs_(std::make_unique<sqlite3_vfs>()) {
  static std::atomic<int> count{0};
  name_ = "power-loss-" + std::to_string(count++);
  *vfs_ = *sqlite3_vfs_find(nullptr);  // clock, randomness and sleep are the system's
  vfs_->szOsFile = sizeof(PowerLossCalls::Handle);
  vfs_->mxPathname = 1024;
  vfs_->pNext = nullptr;
  vfs_->zName = name_.c_str();
  vfs_->pAppData = this;
  vfs_->xOpen = PowerLossCalls::Locked<PowerLossCalls::open>::call;
  vfs_->xDelete = PowerLossCalls::Locked<PowerLossCalls::remove>::call;
  vfs_->xAccess = PowerLossCalls::Locked<PowerLossCalls::access>::call;
  vfs_->xFullPathname = PowerLossCalls::Locked<PowerLossCalls::full_path>::call;
  const int registered = sqlite3_vfs_register(vfs_.get(), 0);
  RUNSTONE_ASSERT(registered == SQLITE_OK);
}

PowerLossVfs::~PowerLossVfs() { sqlite3_vfs_unregister(vfs_.get()); }

void PowerLossVfs::make_default() { sqlite3_vfs_register(vfs_.get(), 1); }

bool PowerLossVfs::operate() {
  if (cut_) return false;
  ++operations_;
  if (operations_ >= cut_at_) cut_ = true;
  return !cut_;
}

void PowerLossVfs::apply(const Change& change, Bytes& to) {
  if (change.truncation) {
    to.resize(change.offset);
    return;
  }
  if (to.size() < change.offset + change.bytes.size())
    to.resize(change.offset + change.bytes.size());
  std::copy(change.bytes.begin(), change.bytes.end(),
            to.begin() + static_cast<std::ptrdiff_t>(change.offset));
}

void PowerLossVfs::power_loss(SplitMix64& chance) {
  const std::lock_guard guard(mutex_);
  ++generation_;
  cut_ = false;
  cut_at_ = ~std::uint64_t{0};
  // The share of unsynced changes that survive, out of 8: 0 loses all of them, 8 loses none.
  const std::uint32_t kindness = chance.below(9);
  const auto kept = [&] { return chance.below(8) < kindness; };

  std::map<std::string, std::shared_ptr<File>> names = durable_names_;
  for (const auto& [path, file] : live_names_) {
    const auto durable = durable_names_.find(path);
    if (durable == durable_names_.end() && kept()) names[path] = file;  // a new name that survived
  }
  for (const auto& [path, file] : durable_names_) {
    if (!live_names_.contains(path) && kept()) names.erase(path);  // a deletion that survived
  }

  live_names_.clear();
  for (const auto& [path, old] : names) {
    // A new object, because connections from before the failure may still hold the old one.
    auto file = std::make_shared<File>();
    file->durable = old->durable;
    for (const Change& change : old->pending) {
      if (change.truncation) {
        if (kept()) apply(change, file->durable);
        continue;
      }
      for (std::size_t at = 0; at < change.bytes.size();) {
        const std::size_t begin = change.offset + at;
        const std::size_t sector_end = (begin / kPowerLossSectorBytes + 1) * kPowerLossSectorBytes;
        const std::size_t bytes = std::min(change.bytes.size() - at, sector_end - begin);
        if (kept()) {
          // Sectors between the old end and this one were allocated but never written, so they have
          // any content.
          const std::size_t old_size = file->durable.size();
          const auto* from = change.bytes.data() + at;
          apply({false, begin, Bytes(from, from + bytes)}, file->durable);
          for (std::size_t i = old_size; i < begin; ++i) {
            file->durable[i] = static_cast<std::uint8_t>(kindness % 2 == 0 ? 0 : chance.next());
          }
        }
        at += bytes;
      }
    }
    file->live = file->durable;
    live_names_[path] = file;
  }
  durable_names_ = live_names_;
}

Bytes PowerLossVfs::contents(const std::string& path) const {
  const std::lock_guard guard(mutex_);
  const auto found = live_names_.find(path);
  return found == live_names_.end() ? Bytes() : found->second->live;
}

}  // namespace runstone::test
