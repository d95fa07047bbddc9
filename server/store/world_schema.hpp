// The schema of a world, the marks in the header of world.sqlite, and the checksum of a row.
// docs/edit-log.md describes every column.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "common/core/bytes.hpp"
#include "common/sql/database.hpp"
#include "common/sqlite/sqlite_file.hpp"
#include "server/store/store_error.hpp"

namespace runstone {

/// "RunS": PRAGMA application_id of every world.
inline constexpr std::uint32_t kApplicationId = 0x52756e53;
/// PRAGMA user_version of a new world: the version of the schema and of the contents of its
/// columns.
inline constexpr std::uint32_t kWorldFormat = 5;
/// The format of a world whose time was corrected (kLogErasKey). It has the schema of kWorldFormat.
/// Older programs refuse this number. If a later program changes the schema, its format is a greater
/// number, because this program opens every world of format 6.
inline constexpr std::uint32_t kWorldFormatOfEras = 6;
/// The format of a world that has a library of builds (kBuildFoldKey): it has two tables more, and its
/// log may have records that programs of format 6 do not know.
inline constexpr std::uint32_t kWorldFormatOfLibrary = 7;
/// The format of a world in which a material has, or had once, a shape or a look with a silhouette
/// (kShapesKey): its material table and its log have what programs of format 7 do not know. It has
/// the tables of a library only if it has a library.
inline constexpr std::uint32_t kWorldFormatOfShapes = 8;
/// The format of a world to which a texture was given (kTexturesKey): its log has, or had, records
/// that programs of format 8 do not know.
inline constexpr std::uint32_t kWorldFormatOfTextures = 9;
/// The format of a world whose clock was set (kClockKey): its log has records that programs of
/// format 9 do not know. It has the tables of a library only if it has a library.
inline constexpr std::uint32_t kWorldFormatOfClock = 10;
/// The format of a world that was repaired and lacks records (kGapsKey): its log has records that
/// programs of format 10 do not know. It has the tables of a library only if it has a library.
inline constexpr std::uint32_t kWorldFormatOfGaps = 11;
/// The format of a world in which a player was given a role for some time (kTimedGrantsKey): its log has
/// records that programs of format 11 do not know.
inline constexpr std::uint32_t kWorldFormatOfTimedGrants = 12;
/// The newest format that this program knows.
inline constexpr std::uint32_t kWorldFormatNewest = kWorldFormatOfTimedGrants;
/// The oldest format that is converted when a world is opened for writing.
inline constexpr std::uint32_t kWorldFormatConverted = 2;

/// Returns "world formats 5, 6, 7, 8, 9, 10, 11 and 12": those that this program makes, for --version.
inline std::string world_formats_text() {
  return "world formats " + std::to_string(kWorldFormat) + ", " +
         std::to_string(kWorldFormatOfEras) + ", " + std::to_string(kWorldFormatOfLibrary) + ", " +
         std::to_string(kWorldFormatOfShapes) + ", " + std::to_string(kWorldFormatOfTextures) +
         ", " + std::to_string(kWorldFormatOfClock) + ", " + std::to_string(kWorldFormatOfGaps) +
         " and " + std::to_string(kWorldFormatOfTimedGrants);
}

/// Makes all tables in the caller's transaction.
StoreResult<void> create_schema(sql::Database& database);
/// Makes the tables that format 3 adds to format 2, without rows, in the caller's transaction.
StoreResult<void> add_tables_of_format_3(sql::Database& database);
/// Makes the table that format 4 adds to format 3, without rows, in the caller's transaction.
StoreResult<void> add_tables_of_format_4(sql::Database& database);
/// Makes the tables of the library of builds, without rows, in the caller's transaction.
StoreResult<void> add_tables_of_library(sql::Database& database);
/// Fails with newer_version, bad_request or corrupt if this program cannot read a world of this
/// format. `file` names the world in the error.
StoreResult<void> check_format(const std::string& file, std::uint32_t version);
/// Reads the marks from the main file alone, so that a file that is refused does not change. `vfs`
/// is that of sql::open_sqlite(). Fails with not_a_world, newer_version or corrupt, and with io if the
/// file cannot be read.
StoreResult<void> check_marks(const std::string& file, const std::string& vfs);

/// Computes the checksum of a row: XXH3-64 of the table's name and of every other column, in the
/// order of the schema.
///   - An integer is 8 bytes, little-endian.
///   - A text or a blob is its length (8 bytes) and its bytes.
///   - edit_log differs: its checksum is record_checksum() of the record.
class RowChecksum {
 public:
  explicit RowChecksum(std::string_view table) { text(table); }
  RowChecksum& integer(std::int64_t value);
  RowChecksum& blob(ByteView value);
  RowChecksum& text(std::string_view value);
  /// Returns the checksum as it is stored: its 64 bits as a signed integer.
  std::int64_t value() const;

 private:
  Bytes bytes_;
};

}  // namespace runstone
