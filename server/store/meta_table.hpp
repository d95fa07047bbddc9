// MetaTable: the values that are pinned when a world is created, and the few that change: epoch,
// checkpoint, the highest author number, head, end and eras of the log, the folds and row counts of
// tables, whether a program is writing the world, and the material table, which compactions extend.
// Threads: the one that owns the store.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/sql/database.hpp"
#include "server/store/log_reader.hpp"
#include "server/world/environment/saved_state.hpp"

namespace runstone {

using MetaValue = std::variant<std::int64_t, std::string, Bytes>;
using MetaRows = std::map<std::string, MetaValue, std::less<>>;

/// Returns the value of the row `spawn`.
Bytes spawn_bytes(const WorldPos& spawn);
/// Returns the pinned rows of a world.
MetaRows rows_of(const WorldMeta& meta);
/// Returns the values in the pinned rows. The error names the first key that is missing or wrong.
Result<WorldMeta, std::string> meta_of(const MetaRows& rows);

/// The number of rows of a table, and the sum of a hash of each row. `meta` holds one for each of
/// the tables base, snapshot, player, player_instance, name_claim, build and build_part. It detects
/// a row that vanished or changed its key, although every remaining row is sound. A change of one
/// row costs O(1).
struct RowFold {
  std::uint64_t count = 0, sum = 0;
  friend bool operator==(const RowFold&, const RowFold&) = default;
};
/// Counts a row with this checksum in the fold of a table whose rows are hashed by their checksums.
inline void add_row(RowFold& fold, std::int64_t checksum) {
  ++fold.count;
  fold.sum += static_cast<std::uint64_t>(checksum);
}
inline void remove_row(RowFold& fold, std::int64_t checksum) {
  --fold.count;
  fold.sum -= static_cast<std::uint64_t>(checksum);
}

/// The numbers of rows in tables without a fold. They count only while `epoch` and `head` are those
/// of the world: an older program changes rows without counting them.
struct RowCounts {
  Epoch epoch = 0;
  Sequence head = 0;  // of the log
  std::uint64_t player_names = 0, keyframes = 0, segments = 0;
  std::uint64_t lost_edits = 0;  // rows of the log whose loss was accepted
};

/// The key of the row that log_eras() reads. Only a world whose time was corrected has it.
inline constexpr const char* kLogErasKey = "log_eras";

/// The key of a row, always 1, that only a world has in which a material has or had a shape.
inline constexpr const char* kShapesKey = "shapes";
/// The key of a row, always 1, that only a world has to which a texture was given.
inline constexpr const char* kTexturesKey = "textures";
/// The key of a row, always 1, that only a world has whose log has or had a gap.
inline constexpr const char* kGapsKey = "gaps";
/// The key of the row that marks a world in which a role was given for some time. The value is 1.
/// Other worlds do not have the row.
inline constexpr const char* kTimedGrantsKey = "timed_grants";

/// The keys of the rows that clock() and places() read. Only a world whose clock was set has the
/// first one.
inline constexpr const char* kClockKey = "world_clock";
inline constexpr const char* kPlacesKey = "player_places";

class MetaTable {
 public:
  static StoreResult<MetaTable> open(sql::Database& database);

  /// Returns all rows. Each checksum is verified. The rows that clock() and places() read are left
  /// out if they are damaged, because no edit depends on them: these two functions fail then.
  StoreResult<MetaRows> read_all();
  /// Writes a row in the caller's transaction, as do put_fold() and put_log_head().
  StoreResult<void> put(const std::string& key, const MetaValue& value);
  /// Returns a counter. Fails (corrupt) if it is missing.
  StoreResult<std::uint64_t> counter(const std::string& key);
  StoreResult<RowFold> fold(const std::string& key);
  StoreResult<void> put_fold(const std::string& key, const RowFold& fold);
  /// Returns row `log_head`: version and time of the last edit that a compaction removed, all 0 if
  /// there was none.
  StoreResult<LogEnd> log_head();
  StoreResult<void> put_log_head(const LogEnd& head);
  /// Returns row `log_eras`: the eras that begin in the log, ascending, behind the first one. Some may
  /// begin before the head of the log.
  StoreResult<std::vector<LogEra>> log_eras();
  StoreResult<void> put_log_eras(const std::vector<LogEra>& eras);
  /// Returns row `row_counts`, or nullopt if there is none or it does not count any more.
  StoreResult<std::optional<RowCounts>> row_counts();
  StoreResult<void> put_row_counts(const RowCounts& counts);
  /// Returns row `open_epoch`: the epoch of the program that is writing the world. Returns nullopt if
  /// the database alone holds the whole world, or if an older program has written it since.
  StoreResult<std::optional<Epoch>> open_epoch();
  StoreResult<void> put_open_epoch(std::optional<Epoch> epoch);

  /// Returns row `world_clock`, or nullopt if there is none. Fails (corrupt) if it has an
  /// impossible value.
  StoreResult<std::optional<SavedClock>> clock();
  /// Returns row `player_places`, or an empty list if there is none. Fails (corrupt) if it has an
  /// impossible value.
  StoreResult<std::vector<LastPlace>> places();
  StoreResult<void> put_clock(const SavedClock& clock);
  StoreResult<void> put_places(const std::vector<LastPlace>& places);
  StoreResult<void> put_spawn(const WorldPos& spawn);

 private:
  MetaTable(std::string file, sql::Statement all, sql::Statement one, sql::Statement write)
      : file_(std::move(file)),
        all_(std::move(all)),
        one_(std::move(one)),
        write_(std::move(write)) {}
  StoreResult<MetaValue> read_row(sql::Statement& row, std::string_view key);
  StoreResult<std::optional<MetaValue>> find(const std::string& key);
  StoreResult<MetaValue> get(const std::string& key);
  Unexpected<StoreError> corrupt(std::string_view key, std::string what) const;

  std::string file_;
  sql::Statement all_, one_, write_;
};

}  // namespace runstone
