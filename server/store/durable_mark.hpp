// DurableMark: the file `world.durable`. It says how far the log of a world was durable, and lies
// outside the database: SQLite drops everything behind the first damaged byte of its WAL without an
// error, and so it drops the whole WAL if that file is lost. A world whose log ends before its mark
// has lost edits.
//   - The mark is never ahead of the disk: it is written after the fsync of the commit that it
//     covers.
//   - After the end of the process, kill -9 included, it covers every commit for which append()
//     returned, because the kernel holds what was written. If a write of the mark fails, it lags
//     until one succeeds.
//   - After a power failure it may lag behind the disk, because not every write of it is synced:
//     that would double the time of a commit. It is synced by each start, with each checkpoint and
//     when the world is closed. A lag makes the check weaker; it never causes a false alarm.
//   - It has two slots, which are written in turn, each with a checksum. A write that is cut off
//     leaves the other slot. Each slot lies in a page of its own, so no two writes share a sector.
//   - It names its world. The mark of another world counts as none, and so does a missing file.
// docs/edit-log.md has the bytes. Threads: the one that owns the store.
#pragma once
#include <compare>
#include <cstdint>
#include <optional>
#include <string>

#include "common/core/ids.hpp"
#include "common/sqlite/vfs_file.hpp"
#include "protocol/codec/messages.hpp"
#include "server/store/durable_state.hpp"
#include "server/store/store_error.hpp"

namespace runstone {

class DurableMark {
 public:
  /// `vfs` is the name of an SQLite VFS; an empty name means the default one. Opens nothing yet.
  DurableMark(const std::string& folder, const WorldId& world, std::string vfs)
      : file_(folder + "/world.durable"), world_(world), vfs_(std::move(vfs)) {}
  /// Calls sync() and ignores its result.
  ~DurableMark();
  DurableMark(const DurableMark&) = delete;
  DurableMark& operator=(const DurableMark&) = delete;

  /// Reads the newer slot, or nullopt if there is no mark. Fails (corrupt) if no slot is sound and
  /// one is damaged.
  StoreResult<std::optional<DurableState>> read();
  /// Writes a state that is on disk. Does nothing if the mark is not older. Makes the file if it
  /// does not exist. Requires that read() was called. A write that fails leaves the older mark, and
  /// the next call tries again.
  StoreResult<void> write(const DurableState& state);
  /// Returns when all that was written is on disk.
  StoreResult<void> sync();

 private:
  const std::string file_;
  const WorldId world_;
  const std::string vfs_;
  std::optional<sql::VfsFile> open_;    // open for writing; empty until the first write
  std::optional<DurableState> newest_;  // of the file
  std::uint64_t next_slot_ = 0;         // the one that does not hold newest_
  bool is_synced_ = true;
};

}  // namespace runstone
