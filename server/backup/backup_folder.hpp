// BackupFolder: a folder of backups of one world. It holds
//   - runstone-backups   the mark of such a folder, which names the world;
//   - TIME.backup        a manifest for each backup;
//   - blocks/            the blocks that the manifests name (BlockFolder);
//   - backups.lock       locked by the program that changes the folder.
// The manifest is renamed last. A backup counts from then on.
// Threads: one thread at a time. All calls block on the disk. Errors are one line, and begin with
// the name of the file.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "common/os/file_lock.hpp"
#include "server/backup/backup_manifest.hpp"
#include "server/backup/backup_policy.hpp"
#include "server/backup/block_folder.hpp"

namespace runstone {

class BackupFolder {
 public:
  /// One backup of the folder.
  struct Entry {
    std::string name;  // such as "20261118T033000Z"
    TimeUs taken_us = 0;
    BackupManifest manifest;
    std::string error;  // empty if the manifest is sound
  };
  struct Pruned {
    std::vector<std::string> names;  // of the backups that are removed
    std::uint64_t freed_bytes = 0;
    std::string warning;  // why no block was removed; empty if there is no reason
  };

  /// Returns true if `folder` has the mark of such a folder.
  static bool is_one(const std::string& folder);
  /// Opens a folder for reading. Fails if it has no mark, or one of a newer version.
  static Result<BackupFolder, std::string> open(const std::string& folder);
  /// Opens a folder for the backups of a world, and locks it. An empty folder gets the mark.
  /// Fails if
  ///   - there is no such folder: a disk may be missing, so none is made;
  ///   - it holds backups of another world, or other files without the mark;
  ///   - another program has the lock, or the folder cannot be written.
  static Result<BackupFolder, std::string> open_for(const std::string& folder,
                                                    const WorldId& world);

  const std::string& path() const { return path_; }
  const WorldId& world() const { return world_; }
  BlockFolder& blocks() { return blocks_; }
  /// Locks the folder, unless this object has the lock. Fails if another program has the lock, or
  /// if the folder cannot be written.
  Result<void, std::string> lock();
  /// Locks the folder for a program that only reads it. Goes on without the lock
  ///   - on storage that cannot be written, because nobody can change it there;
  ///   - if this user may not write the folder. Then the text says so, and is otherwise empty.
  Result<std::string, std::string> lock_for_reading();

  /// Returns the names of all backups, the oldest first.
  Result<std::vector<std::string>, std::string> names() const;
  /// Reads one backup. Memory: up to 1/300 of the bytes of the world while the text is parsed, and
  /// 1/1000 afterwards.
  Entry read(const std::string& name) const;
  /// Reads one backup. The files have no blocks, so this needs no memory for them.
  Entry read_sizes(const std::string& name) const;
  /// Returns all backups, the oldest first. The files have no blocks.
  Result<std::vector<Entry>, std::string> entries() const;
  /// Returns the name of the newest backup: the one of the highest epoch, and of those the one of
  /// the highest sequence. Of equal ones it is the latest that is not after `now_us`. Times do not
  /// decide otherwise, because a clock may have been wrong. Reads the first lines of each manifest.
  /// A damaged one of a later time that is not after `now_us` may be the newest, so its name is
  /// then returned. Fails if there is none.
  Result<std::string, std::string> newest(TimeUs now_us) const;
  /// Reads the backup of this name, or the newest one if the name is empty. Fails if there is none,
  /// or if its manifest is damaged.
  Result<Entry, std::string> find(const std::string& name, TimeUs now_us) const;
  /// Makes a backup of the blocks that are on disk. Fails if there is one of the same second.
  Result<void, std::string> add(const BackupManifest& manifest);
  /// Returns the names of the backups that the policy removes. A backup whose manifest is damaged
  /// does not count, and stays. `now_us` as for backups_to_remove().
  Result<std::vector<std::string>, std::string> to_remove(const BackupPolicy& policy,
                                                          TimeUs now_us) const;
  /// Removes these backups, all blocks that no other backup needs, and what a killed program left.
  /// A damaged manifest may need any block, so while there is one no block is removed. Requires the
  /// lock.
  Result<Pruned, std::string> remove(const std::vector<std::string>& names);

 private:
  BackupFolder(std::string path, const WorldId& world)
      : path_(std::move(path)), world_(world), blocks_(path_ + "/blocks") {}
  std::string file_of(const std::string& name) const { return path_ + "/" + name + ".backup"; }
  /// Returns the entry of a backup whose manifest was read.
  Entry entry_of(const std::string& name, Result<BackupManifest, std::string> read) const;
  /// Removes unfinished manifests, which a killed program left.
  Result<void, std::string> remove_unfinished();

  std::string path_;
  WorldId world_{};
  BlockFolder blocks_;
  std::optional<FileLock> lock_;
};

}  // namespace runstone
