// BuildTable: the library of builds: `build`, a row for each build with the record that added it and
// what is searched, and `build_part`, the bytes of the files. A file is written in parts before the
// record that adds its build. Until then no row of `build` has its content number.
// Threads: the one that owns the store.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/sql/database.hpp"
#include "server/store/library_reader.hpp"
#include "server/store/meta_table.hpp"
#include "server/store/store_error.hpp"

namespace runstone {

/// The bytes of a part of a file. The last part may have fewer.
inline constexpr std::size_t kBuildPartBytes = std::size_t{256} << 10;

/// The keys of the rows of `meta` that count the two tables. A world has the tables if it has the
/// first row.
inline constexpr const char* kBuildFoldKey = "build_fold";
inline constexpr const char* kBuildPartFoldKey = "build_part_fold";

class BuildTable {
 public:
  /// Requires the tables (add_tables_of_library()).
  static StoreResult<BuildTable> open(sql::Database& database);

  /// See LibraryReader.
  StoreResult<std::vector<StoredBuild>> find(const LibraryQuery& query);
  StoreResult<std::optional<StoredBuild>> one(Sequence number);
  StoreResult<std::vector<LibraryRow>> rows();
  StoreResult<void> read(const StoredBuild& build, const EachPart& each) {
    return read_from(build, 0, each);
  }
  StoreResult<Bytes> piece(const StoredBuild& build, std::uint64_t offset, std::size_t bytes_max);
  /// Returns true if a build has this content number.
  StoreResult<bool> is_used(std::uint64_t content);
  /// Returns how many bytes the parts of a content have.
  StoreResult<std::uint64_t> content_bytes(std::uint64_t content);

  /// Adds the row of a build, in the caller's transaction, and updates the fold of `build`. Requires
  /// a record with an AddBuild.
  StoreResult<void> add(const EditRecord& record, RowFold& fold);
  /// Removes a build and the parts of its file, in the caller's transaction, and updates the folds.
  /// Does nothing if there is no build of this number.
  StoreResult<void> remove(Sequence number, RowFold& fold, RowFold& part_fold);
  /// Removes the parts of a content, in the caller's transaction, and updates the fold of
  /// `build_part`.
  StoreResult<void> remove_parts(std::uint64_t content, RowFold& part_fold);
  /// Adds a part, or replaces it, in the caller's transaction, and updates the fold of
  /// `build_part`.
  StoreResult<void> put_part(std::uint64_t content, std::uint32_t part, ByteView data,
                             RowFold& part_fold);
  /// Removes the parts that belong to no build, in the caller's transaction, and updates the fold of
  /// `build_part`. Cost: O(parts), without reading them.
  StoreResult<void> remove_unused_parts(RowFold& part_fold);
  /// Reads and verifies every row of both tables. Returns the folds of what it found. Fails
  /// (corrupt) at the first damaged row, and if a file is not that of its record. Parts that belong
  /// to no build are counted and not read.
  struct Folds {
    RowFold builds, parts;
  };
  StoreResult<Folds> check();

 private:
  struct Statements {
    sql::Statement find, one, rows, add, remove, part, parts, all_parts, part_sums, put_part,
        remove_part, unused, used;
  };
  BuildTable(std::string file, Statements statements)
      : file_(std::move(file)), s_(std::move(statements)) {}
  StoreResult<StoredBuild> build_of(const sql::Statement& row) const;
  /// Calls `each` for the parts of a file from part `first` on.
  StoreResult<void> read_from(const StoredBuild& build, std::uint64_t first, const EachPart& each);
  Unexpected<StoreError> corrupt(std::string where, std::string what) const;

  std::string file_;
  Statements s_;
};

}  // namespace runstone
