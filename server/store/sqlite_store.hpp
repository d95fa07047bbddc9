// SqliteStore: a world in one SQLite database (WAL, synchronous FULL). The rules of Store live here; the
// tables know only their rows. See docs/edit-log.md, "The database".
#pragma once
#include <memory>
#include <string>

#include "common/os/file_lock.hpp"
#include "common/sqlite/database.hpp"
#include "server/store/chunk_table.hpp"
#include "server/store/keyframe_table.hpp"
#include "server/store/log_table.hpp"
#include "server/store/meta_table.hpp"
#include "server/store/player_table.hpp"
#include "server/store/segment_table.hpp"
#include "server/store/sqlite_result.hpp"
#include "server/store/store.hpp"

namespace runstone {

struct SqliteOptions {
  std::string vfs;  // SQLite VFS by name; empty: the default
  bool sync =
      true;  // false is for one test only: it shows that the power-loss test notices a missing fsync
};

/// As create_world() and open_world(), which use the default options.
StoreResult<std::unique_ptr<Store>> create_sqlite_world(const std::string& folder,
                                                        const WorldMeta& meta,
                                                        const SqliteOptions& options);
StoreResult<std::unique_ptr<Store>> open_sqlite_world(const std::string& folder, StoreAccess access,
                                                      const SqliteOptions& options);

class SqliteStore final : public Store {
 public:
  /// Everything is checked before the object exists: marks, meta rows, log ids. `in_file`: as of check_marks().
  static StoreResult<std::unique_ptr<SqliteStore>> open(const std::string& folder,
                                                        StoreAccess access,
                                                        const SqliteOptions& options, FileLock lock,
                                                        std::uint32_t in_file);

  // WorldInfo
  const WorldMeta& meta() const override { return meta_; }
  const std::string& file() const override { return database_->file(); }

  // LogReader
  StoreResult<LogRange> log_range() override;
  StoreResult<LogEnd> log_head() override;
  StoreResult<Sequence> sequence_at(TimeUs time_us) override;
  StoreResult<void> read_log(Sequence first, Sequence last, const EachRecord& each) override;
  StoreResult<void> query_log(const LogQuery& query, const EachRecord& each) override;

  // ChunkReader
  StoreResult<bool> has_base() override;
  StoreResult<std::optional<Chunk>> load_base(const ChunkKey& key) override;
  StoreResult<std::vector<StoredChunk>> base_chunks() override;
  StoreResult<std::optional<Chunk>> load_snapshot(const ChunkKey& key) override;
  StoreResult<std::vector<std::pair<ChunkKey, Version>>> snapshot_keys() override;
  StoreResult<Sequence> checkpoint() override;

  // KeyframeReader
  StoreResult<std::vector<Keyframe>> keyframes() override;
  StoreResult<std::vector<StoredChunk>> keyframe_chunks() override;
  StoreResult<StoredMoment> stored_moment(Sequence at) override;
  StoreResult<std::optional<Chunk>> load_stored(const StoredChunk& chunk) override;
  StoreResult<std::optional<Chunk>> load_kept(const ChunkKey& key, Sequence at) override;

  // PlayerReader
  StoreResult<std::vector<PlayerRow>> players() override;
  StoreResult<std::vector<HighWater>> high_waters() override;

  // WorldReader
  StoreResult<void> check() override;

  // WorldSink
  StoreResult<void> append(std::span<const PlayerRow> players,
                           std::span<const EditRecord> records) override;
  StoreResult<void> save_snapshots(ChunkSpan chunks, std::optional<Sequence> checkpoint) override;
  StoreResult<void> save_keyframe(ChunkSpan chunks,
                                  const std::optional<Keyframe>& keyframe) override;

  // ImportSink
  StoreResult<void> save_base(ChunkSpan chunks) override;
  StoreResult<void> append_history(std::span<const PlayerRow> players,
                                   std::span<const EditRecord> records) override;

  // Maintenance
  StoreResult<void> compact(Sequence keyframe) override;
  StoreResult<void> shrink() override;

  // Store
  StoreResult<Epoch> raise_epoch() override;
  Epoch epoch() const override { return epoch_; }

 private:
  SqliteStore(std::unique_ptr<sql::Database> database, FileLock lock, StoreAccess access,
              MetaTable meta_table, PlayerTable player_table, LogTable log_table, ChunkTable base,
              ChunkTable snapshots);
  /// Calls `body` in one transaction and commits. After a commit that failed nobody knows what is on disk, so
  /// every later write is refused.
  StoreResult<void> write(const std::function<StoreResult<void>()>& body);
  /// Calls `body` while another process's commits stay out of sight: what it reads belongs together.
  template <class T>
  StoreResult<T> at_one_moment(const std::function<StoreResult<T>()>& body);
  StoreResult<std::vector<StoredChunk>> rows_of(ChunkTable& table);
  /// Of base chunks, those that a compaction completed; read only if there was one.
  StoreResult<std::vector<StoredChunk>> completed(const LogEnd& head);
  /// Null in a world of an older format.
  StoreResult<KeyframeTable*> keyframe_table();
  StoreResult<void> complete_base(const StoredMoment& moment);
  StoreResult<void> delete_up_to(const char* text, Sequence last);
  StoreResult<void> check_keyframe(const Keyframe& keyframe, const LogRange& range);
  StoreResult<void> save_chunks(ChunkTable& table, ChunkSpan chunks);
  /// Also that they are of the epoch of now or, for history, that epochs do not fall.
  StoreResult<void> check_continues(std::span<const EditRecord> records, bool history);
  /// In the caller's transaction.
  StoreResult<void> insert(std::span<const PlayerRow> players, std::span<const EditRecord> records);
  StoreResult<void> check_chunks(ChunkTable& table);
  StoreResult<void> check_marks_cover_log();
  StoreResult<void> check_segments_cover_log();
  StoreResult<void> check_keyframes();
  /// A world of an older format gets what it lacks (format 1: indexes, 2: tables of keyframes), in one transaction.
  /// Makes a world of an older format one of the newest. `in_file`: the format that the main file names, which a crash
  /// or a reader may have kept from an upgrade that is in the WAL.
  StoreResult<void> upgrade(std::uint32_t in_file);
  Unexpected<StoreError> refuse(std::string where, std::string what) const;

  // Order matters: statements die before their database, and the database is closed before the lock is let
  // go.
  FileLock lock_;
  std::unique_ptr<sql::Database> database_;
  MetaTable meta_table_;
  PlayerTable player_table_;
  LogTable log_;
  SegmentTable segments_;
  ChunkTable base_, snapshots_;
  std::optional<KeyframeTable>
      keyframes_;  // opened when first needed: older formats lack the tables
  StoreAccess access_;
  WorldMeta meta_;
  Epoch epoch_ = 0;
  bool broken_ = false;
};

template <class T>
StoreResult<T> SqliteStore::at_one_moment(const std::function<StoreResult<T>()>& body) {
  if (const auto begun = database_->run("SAVEPOINT moment"); !begun) {
    return failed(begun.error());
  }
  auto result = body();
  if (const auto ended = database_->run("RELEASE moment"); !ended && result) {
    return failed(ended.error());
  }
  return result;
}

}  // namespace runstone
