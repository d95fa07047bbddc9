// PowerLossVfs: an SQLite file system in memory whose power can fail.
// - Unsynced writes may then be lost, kept, or torn at sector borders, each sector independently,
//   in any subset and so in any order.
// - Files that were never synced may disappear, and unsynced deletions may come back.
// - Synced data stays. It promises what SQLite's default VFS promises on Linux: bytes outside a
//   write are never harmed (powersafe overwrite), and a sync of a new file also syncs its name.
//   Connections of one process share files and WAL memory. Threads: any, for connections and
//   controls; power_loss() requires that no connection of before is used meanwhile.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/hash.hpp"

struct sqlite3_vfs;

namespace runstone::test {

inline constexpr std::size_t kPowerLossSectorBytes = 512;

class PowerLossVfs {
 public:
  /// Registers itself with SQLite under a name of its own.
  PowerLossVfs();
  /// Requires that every connection is closed.
  ~PowerLossVfs();
  PowerLossVfs(const PowerLossVfs&) = delete;
  PowerLossVfs& operator=(const PowerLossVfs&) = delete;

  const std::string& name() const { return name_; }
  /// Makes this the default VFS until it is destroyed, so that whole servers use it.
  void make_default();

  /// Makes the power fail at operation number `operations` from now. Writes, truncations, syncs and
  /// deletions count, from 1. That operation and every later one of open connections fail.
  void cut_after(std::uint64_t operations) {
    const std::lock_guard guard(mutex_);
    cut_at_ = operations_ + operations;
  }
  bool is_cut() const { return locked(cut_); }
  /// Makes the power fail now if it has not failed yet, and restores it. Files keep their synced
  /// data and a random part of the rest. Old connections keep failing.
  void power_loss(SplitMix64& chance);

  /// Makes the next sync fail with an I/O error, as fsync does once on a dying disk. The power
  /// stays on.
  void fail_next_sync() {
    const std::lock_guard guard(mutex_);
    fail_sync_ = true;
  }
  /// Makes every later sync return without an effect, as on a disk that lies.
  void ignore_syncs() {
    const std::lock_guard guard(mutex_);
    ignore_syncs_ = true;
  }

  /// Makes writes find the disk full from operation number `operations` from now on, counted as in
  /// cut_after(). The power stays on.
  void full_after(std::uint64_t operations) {
    const std::lock_guard guard(mutex_);
    full_at_ = operations_ + operations;
  }
  void make_room() {
    const std::lock_guard guard(mutex_);
    full_at_ = ~std::uint64_t{0};
  }

  std::uint64_t operations() const { return locked(operations_); }
  std::uint64_t syncs() const { return locked(syncs_); }
  /// Returns the bytes of a file as programs see them now; empty if there is none.
  Bytes contents(const std::string& path) const;

 private:
  friend struct PowerLossCalls;  // the C functions that SQLite calls

  /// One change that is not on disk yet: bytes at an offset, or a new size.
  struct Change {
    bool truncation = false;
    std::size_t offset = 0;
    Bytes bytes;
  };
  struct File {
    Bytes live, durable;
    std::vector<Change> pending;
    int readers = 0;                 // locks of the rollback protocol
    const void* reserved = nullptr;  // the connection that holds it, if any
    const void* pending_lock = nullptr;
    const void* exclusive = nullptr;
    std::vector<std::unique_ptr<Bytes>> shared_memory;
    // The holders of each lock; exclusive if the flag is set.
    std::vector<const void*> shared_memory_users[8];
    bool shared_memory_exclusive[8] = {};
  };

  template <class T>
  T locked(const T& member) const {
    const std::lock_guard guard(mutex_);
    return member;
  }
  /// Counts an operation. Returns false if the power is off.
  bool operate();
  static void apply(const Change& change, Bytes& to);

  std::string name_;
  std::unique_ptr<sqlite3_vfs> vfs_;
  mutable std::mutex mutex_;  // guards all members from here on
  std::map<std::string, std::shared_ptr<File>> live_names_, durable_names_;
  // Raised by each power loss; connections remember theirs.
  std::uint64_t generation_ = 0;
  std::uint64_t operations_ = 0, syncs_ = 0, cut_at_ = ~std::uint64_t{0},
                full_at_ = ~std::uint64_t{0};
  bool cut_ = false, fail_sync_ = false, ignore_syncs_ = false;
};

}  // namespace runstone::test
