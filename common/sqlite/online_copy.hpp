// sql::OnlineCopy: copies a database into another one, page by page, while other connections write
// it. The copy is of one moment: that of the source's read transaction. SQLite begins a copy anew
// when the source changes under it, so a copy without that transaction need never end under
// constant writing.
// Threads: the one that owns both databases.
#pragma once
#include <cstdint>
#include <memory>

#include "common/sql/database.hpp"

struct sqlite3_backup;

namespace runstone::sql {

class OnlineCopy {
 public:
  /// Requires two databases of open_sqlite(), that `from` has an open read transaction, that `to`
  /// is new, and that both outlive the object. Fails (bad_statement) without the transaction.
  static Result<OnlineCopy> begin(Database& from, Database& to);

  /// Copies at most `pages` further pages. Returns false if the copy is complete. A copy that is
  /// destroyed before that leaves a file that is no database. An error names the file that caused it.
  Result<bool> step(int pages);
  /// Return the numbers of pages as of the last step().
  std::uint64_t pages_left() const;
  std::uint64_t page_count() const;

 private:
  struct Finish {
    void operator()(sqlite3_backup* handle) const;
  };
  OnlineCopy(sqlite3_backup* handle, Database& from, Database& to)
      : handle_(handle), from_(&from), to_(&to) {}
  std::unique_ptr<sqlite3_backup, Finish> handle_;
  Database *from_, *to_;
};

}  // namespace runstone::sql
