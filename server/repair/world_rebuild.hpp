// WorldRebuild: fills the tables of a new world with the sound rows of a damaged one. It writes all
// rows that cannot be made again from others, and the values of `meta`; GroundRebuild makes the
// snapshots.
// Threads: the one that owns the database.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/sql/database.hpp"
#include "server/repair/backup_rows.hpp"
#include "server/repair/found_rows.hpp"
#include "server/repair/log_gaps.hpp"
#include "server/repair/page_file.hpp"
#include "server/repair/repair_report.hpp"
#include "server/store/durable_state.hpp"
#include "server/store/meta_table.hpp"
#include "server/world/environment/player_rows.hpp"

namespace runstone {

class WorldRebuild {
 public:
  /// `folder` has the damaged world and its durable mark. `backup` may be null. `now_us` is the
  /// time in UTC. All must outlive the object.
  WorldRebuild(const std::string& folder, PageFile& pages, BackupRows* backup, TimeUs now_us,
               RepairReport& report)
      : folder_(folder), pages_(pages), backup_(backup), now_us_(now_us), report_(report) {}

  /// Makes the tables of the new world and fills them, in the caller's transaction. `on_progress`
  /// gets pages. Fails (corrupt) if a value of `meta` that cannot be made anew is lost.
  StoreResult<void> fill(sql::Database& database,
                         const std::function<void(std::uint64_t, std::uint64_t)>& on_progress);
  /// Returns the edge of the chunks. Requires fill().
  std::int32_t chunk_edge() const;
  /// Returns the next client sequence of the server's edits in this repair.
  OperationId next_operation() { return {0, instance(), ++operations_}; }

 private:
  ClientInstance instance() const { return static_cast<ClientInstance>(now_us_); }
  StoreResult<void> find_rows(const std::function<void(std::uint64_t, std::uint64_t)>& on_progress);
  StoreResult<void> find_pinned_values();
  /// Finds the material table again if `meta` has lost it. Requires that the log has its records.
  StoreResult<void> find_materials();
  StoreResult<void> find_head();
  StoreResult<void> read_mark();
  StoreResult<void> rebuild_log();
  StoreResult<void> report_lost(const std::vector<Sequence>& lost,
                                const std::map<Sequence, LostRecord>& known);
  /// Returns how many rows of the table the backup gave.
  StoreResult<std::uint64_t> fill_from_backup(FoundTable table);
  /// Fills a table from the backup if rows of it are missing, and reports what stays lost.
  StoreResult<void> complete(FoundTable table);
  StoreResult<void> complete_names();
  StoreResult<void> complete_tables();
  StoreResult<void> complete_library();
  /// Reads the log once and makes what follows from it: segments, watermarks, eras, marks of kinds.
  StoreResult<void> follow_log();
  /// Writes the watermark of the records that stand for lost ones, and the row that says that
  /// watermarks are lost.
  StoreResult<void> raise_own_marks();
  StoreResult<void> write_meta();

  const std::string folder_;
  PageFile& pages_;
  BackupRows* backup_;
  const TimeUs now_us_;
  RepairReport& report_;
  sql::Database* database_ = nullptr;
  std::optional<FoundRows> found_;
  MetaRows meta_;  // of the new world
  LogEnd head_;
  DurableState state_;  // of the world, as far as it is known
  std::vector<LogEra> eras_;
  std::uint64_t segments_ = 0;
  HighWater own_mark_;
  bool are_watermarks_lost_ = false, are_materials_lost_ = false;
  ClientSequence operations_ = 0;
};

}  // namespace runstone
