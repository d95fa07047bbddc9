// BlockFolder: blocks of bytes, each once, in files that are named by the hash of their bytes. So
// backups share equal blocks.
//   - A block's file is complete when it has its name: it is written as NAME.new, synced, and
//     renamed.
//   - A block that is there is read and compared before it is used again, so a damaged one is
//     replaced as long as the world still has its bytes.
// Threads: one thread at a time. All calls block on the disk. Errors begin with the name of the
// file.
#pragma once
#include <cstdint>
#include <set>
#include <string>
#include <utility>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "server/backup/backup_manifest.hpp"

namespace runstone {

class BlockFolder {
 public:
  /// `folder` need not exist: put() makes it.
  explicit BlockFolder(std::string folder) : folder_(std::move(folder)) {}

  struct Stored {
    BlockHash hash{};
    std::uint64_t written = 0;  // bytes; 0: the block was there
  };
  /// Stores a block, unless it is there. Requires 1 .. kBlockBytes bytes.
  Result<Stored, std::string> put(ByteView block);
  /// Returns when the names of all blocks that put() has written or found are on disk.
  Result<void, std::string> sync();
  /// Returns the bytes of a block. Fails if it is missing, damaged, or has not `bytes` bytes.
  Result<Bytes, std::string> get(const BlockHash& hash, std::size_t bytes) const;
  /// Removes all blocks that are not among `used`, and what a put() that was killed left. Returns
  /// the bytes that came free. Files of other names, and those that are not where put() writes
  /// them, stay. Fails if the folder is a symbolic link, and removes nothing then.
  Result<std::uint64_t, std::string> keep_only(const std::set<BlockHash>& used) const;

 private:
  std::string folder_of(const std::string& name) const;

  const std::string folder_;
  std::set<std::string> written_;  // the folders that have new names since the last sync()
};

/// Returns when the names in a folder are on disk. The error begins with the name of the folder.
Result<void, std::string> sync_names(const std::string& folder);

}  // namespace runstone
