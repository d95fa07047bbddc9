// FaultVfs: the system's SQLite VFS, whose calls of the system a test can make fail: SQLite's own code
// turns the error of the system into its own. A sync fails as fsync does; it never reaches the disk,
// so tests with very many worlds are fast.
// An error is injected only into calls that can have it: EIO into all of them, EROFS into those that
// write or open a file to write it, ENOSPC and EDQUOT into those that write or make a file, EFBIG into
// those that write.
// The calls of the system fail for every VFS of SQLite that makes them, the default one included, so
// that whole servers meet them too. Only this VFS leaves out syncs.
// Threads: any. One object at a time.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

struct sqlite3_vfs;

namespace runstone::test {

class FaultVfs {
 public:
  enum class Lasts { once, for_ever };

  /// Registers itself with SQLite under name().
  FaultVfs();
  /// Requires that every connection is closed.
  ~FaultVfs();
  FaultVfs(const FaultVfs&) = delete;
  FaultVfs& operator=(const FaultVfs&) = delete;

  static constexpr const char* name() { return "runstone-fault"; }
  /// Makes call number `call` from now, counted from 1 among those that can have the error, fail with
  /// this error of the system, and every later one too if it lasts for ever.
  void fail(std::uint64_t call, int system_error, Lasts lasts);
  /// Lets every call succeed from now on.
  void heal();
  /// Returns true if a call has failed since the last fail().
  bool has_failed() const;

 private:
  sqlite3_vfs* system_;
  std::unique_ptr<sqlite3_vfs> vfs_;
};

}  // namespace runstone::test
