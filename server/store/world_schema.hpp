// The schema of world.sqlite, its marks in the file header, and the row checksum. docs/edit-log.md describes
// every column.
#pragma once
#include <cstdint>
#include <string_view>

#include "common/core/bytes.hpp"
#include "common/sqlite/database.hpp"
#include "server/store/store_error.hpp"

namespace runstone {

/// "RunS": PRAGMA application_id of every world. PRAGMA user_version holds kStoreFormatVersion.
inline constexpr std::uint32_t kApplicationId = 0x52756e53;

/// Makes all tables and sets both marks, in the caller's transaction.
StoreResult<void> create_schema(sql::Database& database);

/// Since this format worlds have indexes over the log.
inline constexpr std::int64_t kIndexedFormat = 2;
/// What format 2 has more than format 1, the mark included; the segments are empty. In the caller's transaction.
StoreResult<void> create_indexes(sql::Database& database);

/// Since this format worlds have keyframes.
inline constexpr std::int64_t kKeyframeFormat = 3;
/// What format 3 has more than format 2, the mark included; the tables are empty. In the caller's transaction.
StoreResult<void> create_keyframes(sql::Database& database);

/// Marks the newest format. Format 4 has the tables of format 3; chunks that are written are packed of version 2, which
/// programs before it cannot read. In the caller's transaction.
StoreResult<void> mark_newest(sql::Database& database);

/// Reads the marks from the main file alone, so that a file which is refused stays untouched. `vfs` as in
/// sql::Database::open. Returns the format that the main file names; fails with not_a_world, newer_version or corrupt.
StoreResult<std::uint32_t> check_marks(const std::string& file, const std::string& vfs);

/// Checksum of one row: XXH3-64 of the table's name and every other column in schema order. Integers go in as
/// 8 bytes little-endian, text and blobs as their length (8 bytes) and their bytes. edit_log alone differs:
/// its checksum is record_checksum() of the record.
class RowChecksum {
 public:
  explicit RowChecksum(std::string_view table) { text(table); }
  RowChecksum& integer(std::int64_t value);
  RowChecksum& blob(ByteView value);
  RowChecksum& text(std::string_view value);
  /// As stored: the 64 bits as a signed integer.
  std::int64_t value() const;

 private:
  Bytes bytes_;
};

}  // namespace runstone
