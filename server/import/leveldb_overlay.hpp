// LeveldbOverlay: the environment in which a LevelDB opens a folder for reading only. LevelDB
// itself has no such mode: it makes a new manifest and rewrites its log when it opens. Here files
// are read from the folder, all that is written stays in memory, and removed files are only hidden.
// So nothing in the folder changes, and no copy of it is made. Internal to luanti_leveldb_map.cpp.
//   - While the database opens, it may write: the rows of its log become tables in memory, which are
//     bounded.
//   - After freeze() each write fails. The database notes the error, never compacts, and goes on
//     reading.
//   - Files are read with pread() and not mapped: a file that another program cuts short is an error
//     of a read, not a signal.
// Threads: any; LevelDB calls it from its background thread, too.
#pragma once
#include <leveldb/env.h>

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace runstone {

class LeveldbOverlay final : public leveldb::EnvWrapper {
 public:
  /// The bytes that the database may write while it opens.
  explicit LeveldbOverlay(std::size_t written_max);
  ~LeveldbOverlay() override;

  /// Ends writing. Call it once, after the database was opened, also if opening failed. Work that
  /// the database wants to do in the background begins only now.
  void freeze();
  /// Returns true if another process has the folder locked for writing.
  bool is_in_use() const { return is_in_use_; }

  leveldb::Status NewSequentialFile(const std::string& file,
                                    leveldb::SequentialFile** out) override;
  leveldb::Status NewRandomAccessFile(const std::string& file,
                                      leveldb::RandomAccessFile** out) override;
  leveldb::Status NewWritableFile(const std::string& file, leveldb::WritableFile** out) override;
  leveldb::Status NewAppendableFile(const std::string& file, leveldb::WritableFile** out) override;
  bool FileExists(const std::string& file) override;
  leveldb::Status GetChildren(const std::string& folder, std::vector<std::string>* out) override;
  leveldb::Status RemoveFile(const std::string& file) override;
  leveldb::Status CreateDir(const std::string& folder) override;
  leveldb::Status RemoveDir(const std::string& folder) override;
  leveldb::Status GetFileSize(const std::string& file, std::uint64_t* out) override;
  leveldb::Status RenameFile(const std::string& from, const std::string& to) override;
  /// Takes a shared lock on the file of the lock, if there is one. So a Luanti server that runs is
  /// noticed, and one that starts meanwhile is refused by its own LevelDB.
  leveldb::Status LockFile(const std::string& file, leveldb::FileLock** out) override;
  leveldb::Status UnlockFile(leveldb::FileLock* lock) override;
  void Schedule(void (*work)(void*), void* argument) override;
  leveldb::Status NewLogger(const std::string& file, leveldb::Logger** out) override;

 private:
  using Content = std::shared_ptr<std::string>;
  class MemoryFile;
  /// Returns the bytes of a file that was written, or null.
  Content written(const std::string& file) const;
  bool is_removed(const std::string& file) const;
  leveldb::Status append(std::string& content, const char* bytes, std::size_t count);

  mutable std::mutex mutex_;
  std::map<std::string, Content> written_;
  std::set<std::string> removed_;
  std::size_t room_;
  bool is_frozen_ = false;
  bool is_in_use_ = false;
  std::vector<std::pair<void (*)(void*), void*>> waiting_;  // background work
};

}  // namespace runstone
