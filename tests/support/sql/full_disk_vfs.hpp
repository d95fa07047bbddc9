// FullDiskVfs: the system's SQLite VFS, which a test can make full: every write then fails as on a
// disk without space. While the object exists it is the default VFS, so whole servers use it.
// Threads: fill() and make_room() from any thread. One object at a time.
#pragma once
#include <memory>

struct sqlite3_vfs;

namespace runstone::test {

class FullDiskVfs {
 public:
  FullDiskVfs();
  /// Requires that every connection is closed.
  ~FullDiskVfs();
  FullDiskVfs(const FullDiskVfs&) = delete;
  FullDiskVfs& operator=(const FullDiskVfs&) = delete;

  void fill();
  void make_room();

 private:
  sqlite3_vfs* system_;
  std::unique_ptr<sqlite3_vfs> vfs_;
};

}  // namespace runstone::test
