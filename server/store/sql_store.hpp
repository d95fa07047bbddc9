// SqlStore: a world in the tables of an SQL database. It enforces the rules of Store; the tables
// know only their rows, and the backend knows the database system. docs/edit-log.md, "The
// database", describes the tables.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/sql/database.hpp"
#include "server/store/build_table.hpp"
#include "server/store/chunk_table.hpp"
#include "server/store/claim_table.hpp"
#include "server/store/durable_state.hpp"
#include "server/store/kept_records.hpp"
#include "server/store/keyframe_table.hpp"
#include "server/store/log_table.hpp"
#include "server/store/meta_table.hpp"
#include "server/store/name_table.hpp"
#include "server/store/player_table.hpp"
#include "server/store/segment_table.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/store.hpp"
#include "server/store/tile_table.hpp"
#include "server/store/world_backend.hpp"

namespace runstone {

class SqlStore final : public Store {
 public:
  ~SqlStore() override;
  /// Opens a world. Converts an older format if it is open for writing. Checks meta rows and log
  /// ids, and whether the log is as long as it was durable.
  static StoreResult<std::unique_ptr<SqlStore>> open(std::unique_ptr<WorldBackend> backend,
                                                     StoreAccess access);

  // WorldInfo
  const WorldMeta& meta() const override { return meta_; }
  const std::string& file() const override { return backend_->database().file(); }

  // LogReader
  StoreResult<LogRange> log_range() override;
  StoreResult<LogEnd> log_head() override;
  StoreResult<Sequence> sequence_at(TimeUs time_us) override;
  StoreResult<void> read_log(Sequence first, Sequence last, const EachRecord& each) override;
  StoreResult<void> query_log(const LogQuery& query, const EachRecord& each) override;
  StoreResult<void> rows_of_author(AuthorId author, Sequence last, const EachRow& each) override;
  StoreResult<void> read_rights(const EachRecord& each) override {
    return read_kept(Cause::rights, each);
  }
  StoreResult<void> read_textures(const EachRecord& each) override {
    return read_kept(Cause::textures, each);
  }
  using LogReader::materials;
  StoreResult<MaterialTable> materials(Sequence at) override;

  // ChunkReader
  void set_row_check(RowCheck check) override { row_check_ = check; }
  StoreResult<bool> has_base() override;
  StoreResult<std::optional<Chunk>> load_base(const ChunkKey& key) override;
  StoreResult<std::vector<StoredChunk>> base_chunks() override;
  using ChunkReader::load_snapshot;
  StoreResult<std::optional<Chunk>> load_snapshot(const ChunkKey& key, Sequence last) override;
  StoreResult<std::vector<std::pair<ChunkKey, Version>>> snapshot_keys() override;
  StoreResult<Sequence> checkpoint() override;
  StoreResult<std::optional<Chunk>> load_tile(const ChunkKey& key, std::uint32_t rules) override;
  StoreResult<std::vector<std::pair<ChunkKey, Version>>> tile_keys(std::uint32_t rules) override;
  StoreResult<std::vector<std::string>> rows_of_no_tile() override;

  // LibraryReader
  StoreResult<std::vector<StoredBuild>> builds(const LibraryQuery& query) override;
  StoreResult<std::optional<StoredBuild>> build(Sequence number) override;
  StoreResult<void> read_build(const StoredBuild& build, const EachPart& each) override;
  StoreResult<Bytes> read_build_piece(const StoredBuild& build, std::uint64_t offset,
                                      std::size_t bytes_max) override;
  StoreResult<std::vector<LibraryRow>> library_rows() override;

  // WorldReader
  StoreResult<std::vector<Keyframe>> keyframes() override;
  StoreResult<std::vector<StoredChunk>> keyframe_chunks() override;
  StoreResult<StoredMoment> stored_moment(Sequence at) override;
  StoreResult<std::optional<Chunk>> load_stored(const StoredChunk& chunk) override;
  StoreResult<std::optional<Chunk>> load_kept(const ChunkKey& key, Sequence at) override;
  StoreResult<std::vector<PlayerRow>> players() override;
  StoreResult<std::vector<UsedName>> player_names() override;
  StoreResult<std::vector<NameClaim>> name_claims() override;
  StoreResult<std::vector<HighWater>> high_waters() override;
  StoreResult<std::vector<LastPlace>> saved_places() override;
  StoreResult<std::optional<SavedClock>> saved_clock() override;
  AuthorId author_max() const override { return state_.author_max; }
  StoreResult<LogVolume> log_volume(Sequence last) override;
  StoreResult<FreeSpace> free_space() override { return backend_->free_space(); }
  StoreResult<void> begin_reads() override;
  StoreResult<void> end_reads() override;
  const std::optional<StoreError>& loss() const override { return loss_; }
  StoreResult<void> check_counts() override;
  StoreResult<void> check() override;

  // WorldSink
  bool is_owned() const override { return backend_->is_owned(); }
  void watch_ownership(std::function<void(const StoreError&)> on_lost) override {
    backend_->watch_ownership(std::move(on_lost));
  }
  StoreResult<void> publish_address(const std::string& address) override;
  void give_up() override { backend_->give_up(); }
  bool is_usable() const override { return backend_->database().is_connected(); }
  StoreResult<void> append(std::span<const PlayerRow> players,
                           std::span<const EditRecord> records) override;
  StoreResult<void> change_names(std::span<const NameChange> changes) override;
  StoreResult<void> save_state(const SavedState& state) override;
  StoreResult<void> save_snapshots(ChunkSpan chunks, std::optional<Sequence> checkpoint) override;
  StoreResult<void> save_keyframe(ChunkSpan chunks,
                                  const std::optional<Keyframe>& keyframe) override;
  StoreResult<void> save_build_part(std::uint64_t content, std::uint32_t part,
                                    ByteView data) override;
  StoreResult<void> remove_build_file(std::uint64_t content) override;
  StoreResult<void> save_tiles(ChunkSpan tiles, std::uint32_t rules) override;
  StoreResult<void> fold_log(const LogFold& fold) override;
  StoreResult<bool> give_back_space(std::uint32_t pages) override;

  // ImportSink
  StoreResult<void> save_base(ChunkSpan chunks) override;
  StoreResult<void> append_history(std::span<const PlayerRow> players,
                                   std::span<const EditRecord> records) override;

  // Store
  StoreResult<Epoch> raise_epoch() override;
  StoreResult<Epoch> begin_branch(TimeUs now_us) override;
  Epoch epoch() const override { return state_.epoch; }
  StoreResult<std::vector<std::string>> accept_losses() override;
  StoreResult<void> compact(Sequence keyframe) override;
  StoreResult<std::vector<ChunkKey>> chunk_keys(ChunkRows rows,
                                                const std::optional<ChunkKey>& behind,
                                                std::size_t count) override;
  StoreResult<void> complete_file() override;
  StoreResult<void> shrink() override;

 private:
  /// The tables of an open database.
  struct Tables {
    MetaTable meta;
    PlayerTable players;
    NameTable names;
    std::optional<ClaimTable> claims;
    std::optional<KeptRecords> kept;
    LogTable log;
    SegmentTable segments;
    ChunkTable base, snapshots;
    KeyframeTable keyframes;
    std::optional<TileTable> tiles;
    static StoreResult<Tables> open(WorldBackend& backend);
  };
  SqlStore(std::unique_ptr<WorldBackend> backend, StoreAccess access, Tables tables,
           WorldMeta meta);
  sql::Database& database() { return backend_->database(); }
  /// Converts a world of an older format, in one transaction.
  StoreResult<void> convert();
  /// Returns the rules of tiles of the materials that are written. `rows`: of `meta`.
  StoreResult<std::uint32_t> present_tile_rules(const MetaRows& rows);
  /// Deletes all tiles and records the present rules, in the caller's transaction.
  StoreResult<void> delete_tiles();
  /// Adds what format 3 has and format 2 lacks: the players own their names, and of several players
  /// with one name the oldest. The log of such a world has no changes of rights.
  StoreResult<void> convert_to_format_3();
  StoreResult<void> add_claims();
  /// Reads the mark, then the numbers of the database, and compares them. Sets loss_. Fails
  /// if the database cannot be repaired, unless it is open for reading only.
  StoreResult<void> read_state();
  /// Makes `epoch` the world's, in database and mark. Both are on disk on return.
  StoreResult<Epoch> set_epoch(Epoch epoch);
  /// Follows a commit that changed the state. A mark that cannot be written lags.
  void committed(const DurableState& state);
  /// Forgets what the tables keep in memory of a transaction that was rolled back.
  void forget_uncommitted() {
    segments_.forget();
    player_table_.forget();
    counts_.reset();
    is_format_raised_ = false;
    if (std::exchange(is_library_new_, false)) library_.reset();
  }
  /// Calls `body` in one transaction and commits. If the disk is full, nothing is written, and the
  /// call may be repeated. After any other failed commit the state of the disk is unknown, so every
  /// later write is refused.
  StoreResult<void> transact(const std::function<StoreResult<void>()>& body);
  /// Calls begin_writing(), then transact().
  StoreResult<void> write(const std::function<StoreResult<void>()>& body);
  /// Before the first change of the world: says in the main file itself that it is not complete
  /// without its WAL and its mark.
  StoreResult<void> begin_writing();
  /// Writes the epoch, and what counts for one epoch only, in the caller's transaction.
  StoreResult<void> put_epoch(Epoch epoch);
  /// Calls `body` in one read transaction: commits of other processes are not visible to it.
  template <class T>
  StoreResult<T> at_one_moment(const std::function<StoreResult<T>()>& body);
  StoreResult<std::vector<StoredChunk>> rows_of(ChunkTable& table);
  /// Returns the base chunks that a compaction completed. Reads nothing if there was no compaction.
  StoreResult<std::vector<StoredChunk>> completed(const LogEnd& head);
  StoreResult<void> complete_base(const StoredMoment& moment);
  /// Checks that the chunks of a fold are those that its edits touch. Returns true if an edit
  /// changes the material table.
  StoreResult<bool> check_fold_chunks(const LogFold& fold, const LogRange& range);
  /// Fails (corrupt) if the log has edits behind `last` but lacks the first of them. No program
  /// could read a log that begins with a lost edit.
  StoreResult<void> check_new_beginning(Sequence last);
  /// Moves the head of the log, in the caller's transaction, and deletes all edits, eras, segments
  /// and keyframes up to there. `lacks_none` means that the log has each of these edits. Then lost
  /// edits are not counted again, which would cost O(edits of the log).
  StoreResult<void> move_head(const LogEnd& head, bool lacks_none);
  /// Calls `each` for the records of this cause that compactions kept, then for those of the log.
  StoreResult<void> read_kept(Cause cause, const EachRecord& each);
  /// Copies the records of this cause that the log holds up to `last` to the table of those that
  /// are kept.
  StoreResult<void> keep_records(Cause cause, Sequence last);
  /// Writes the material table after edit `last` to `meta` and returns it.
  StoreResult<MaterialTable> keep_materials(Sequence last);
  /// Appends the rows of a record. Fails (corrupt) if they do not continue the table.
  StoreResult<void> append_materials(const EditRecord& record, MaterialTable& table) const;
  /// Marks the world as one with textures if a record gives one.
  StoreResult<void> mark_textures(std::span<const EditRecord> records);
  /// Marks the world as one with gaps if a record is one.
  StoreResult<void> mark_gaps(std::span<const EditRecord> records);
  /// Marks the world as a world with roles for some time if a record gives such a role.
  StoreResult<void> mark_timed_grants(std::span<const EditRecord> records);
  /// Marks the world as one with shapes if a record gives some or has a look with a silhouette, and
  /// records the rules of tiles that follow. Deletes the tiles if a voxel of such a material may be
  /// below one. Call it before the records are inserted.
  StoreResult<void> mark_shapes(std::span<const EditRecord> records);
  /// Notes the clock that the newest of these records sets, in the caller's transaction.
  StoreResult<void> set_clock(std::span<const EditRecord> records);
  /// Fails (bad_request) if new materials or shapes among the records do not continue the material
  /// table.
  StoreResult<void> check_continues_materials(std::span<const EditRecord> records);
  StoreResult<void> delete_up_to(const char* text, Sequence last);
  StoreResult<void> check_keyframe(const Keyframe& keyframe, const LogRange& range);
  StoreResult<void> save_chunks(ChunkTable& table, ChunkSpan chunks);
  /// Fails (bad_request) if the records do not continue the log. Their epoch must be the current
  /// one; in a history, epochs must not fall.
  StoreResult<void> check_continues(std::span<const EditRecord> records, bool history);
  using Watermarks = std::map<std::pair<AuthorId, ClientInstance>, HighWater>;
  static void raise(Watermarks& marks, const EditRecord& record);
  /// Inserts players, records and watermarks in the caller's transaction. Sets `next` to the state
  /// that follows.
  StoreResult<void> insert(std::span<const PlayerRow> players, std::span<const EditRecord> records,
                           bool is_history, DurableState& next);
  /// Lists the eras that begin at these records, in the caller's transaction.
  StoreResult<void> add_eras(std::span<const EditRecord> records);
  /// Opens the tables of the library, if the world has them and they are not open. A reader of a
  /// running server finds them when the first build is added.
  StoreResult<void> open_library();
  /// Makes the tables of the library if the world has none, in the caller's transaction.
  StoreResult<void> make_library();
  /// Follows the changes of the library among the records, in the caller's transaction. A build whose
  /// file is not in the store is refused, or left out in a history: an .rlog has no files.
  StoreResult<void> apply_library(std::span<const EditRecord> records, bool is_history);
  StoreResult<void> put_library_folds(const RowFold& builds, const RowFold& parts);
  StoreResult<void> check_library();
  StoreResult<void> accept_lost_builds(std::vector<std::string>& lost);
  /// Makes the world one of this format unless it is of a later one, in the caller's transaction. The
  /// commit then moves the number into the main file.
  StoreResult<void> raise_format(std::uint32_t format);
  StoreResult<void> put_players(std::span<const PlayerRow> players);
  StoreResult<void> raise_watermarks(const Watermarks& marks);
  /// Adds to `lost` what the tables lack that have folds or counts, and counts the rest anew.
  StoreResult<void> accept_lost_rows(std::vector<std::string>& lost);
  StoreResult<void> accept_lost_chunks(std::vector<std::string>& lost);
  StoreResult<void> accept_lost_counts(std::vector<std::string>& lost);
  StoreResult<std::uint64_t> count_of(const char* table);
  /// Counts the rows of the tables without a fold.
  StoreResult<RowCounts> counted_rows();
  StoreResult<void> put_counts(const RowCounts& counts);
  /// Writes the segments of the log that have changed, and counts the new ones.
  StoreResult<void> flush_segments();
  /// Makes the segments of the log again from its rows, in the caller's transaction. Cost: O(log rows).
  StoreResult<void> make_segments_again();
  /// Applies a change to the row counts in the caller's transaction, unless they do not count.
  StoreResult<void> change_counts(const std::function<void(RowCounts&)>& change);
  /// Returns how many rows the log lacks between its first and its last one. Returns 0 in PostgreSQL,
  /// which would read the whole table.
  StoreResult<std::uint64_t> count_lost_edits();
  StoreResult<void> check_base_count();
  /// Returns an error (corrupt) for each table without a fold, and for the log, that lacks rows.
  StoreResult<std::vector<StoreError>> missing_rows();
  StoreResult<StoreError> lost_edits_error(std::uint64_t lost);
  /// Fails (corrupt) if the rows of a table are not those that `meta` counts. `more` completes the
  /// error.
  StoreResult<void> check_fold(const std::string& table, const RowFold& found,
                               const std::string& more = "");
  StoreResult<void> check_players(const FoldedRows<PlayerRow>& players);
  StoreResult<void> check_chunks(ChunkTable& table);
  /// Checks that a watermark covers each edit of the log, that times fall only where an era begins, and
  /// that `meta` lists the eras. Cost: one pass over the log.
  StoreResult<void> check_log_rows();
  StoreResult<void> check_segments_cover_log();
  StoreResult<void> check_keyframes();
  Unexpected<StoreError> refuse(std::string where, std::string what) const;

  std::unique_ptr<WorldBackend> backend_;  // is destroyed after the statements of the tables
  MetaTable meta_table_;
  PlayerTable player_table_;
  NameTable names_;
  // nullopt: a world of format 2 that is open for reading only
  std::optional<ClaimTable> claims_;
  std::optional<KeptRecords> kept_;
  LogTable log_;
  SegmentTable segments_;
  // The row counts as they were written last; nullopt: they must be read. They are kept so that a
  // commit with new segments costs one more write and no read.
  std::optional<RowCounts> counts_;
  ChunkTable base_, snapshots_;
  KeyframeTable keyframes_;
  // nullopt: the world lacks the table and is open for reading only
  std::optional<TileTable> tiles_;
  std::optional<BuildTable> library_;  // nullopt: the world has no library, or it is not open yet
  StoreAccess access_;
  RowCheck row_check_ = RowCheck::voxels;
  WorldMeta meta_;
  /// The greatest numbers of database and mark.
  DurableState state_;
  std::optional<StoreError> loss_;
  bool is_mark_unknown_ = false;  // it is damaged, or missing although the world needs it
  bool has_mark_file_ = false;
  bool is_open_ = false;          // `meta` says that the database is being written
  bool is_open_in_file_ = false;  // this program has written that into the main file
  // Because of a reader, the statement that the database is being written, or the number of the
  // format, is in the WAL alone still.
  bool is_reader_in_the_way_ = false;
  bool is_format_raised_ = false;  // by the present transaction
  bool is_library_new_ = false;    // the present transaction makes its tables
  bool is_whole_ = false;          // this program may say so when it closes the world
  bool broken_ = false;
};

template <class T>
StoreResult<T> SqlStore::at_one_moment(const std::function<StoreResult<T>()>& body) {
  if (const auto begun = database().begin_reads(); !begun) {
    return failed(begun.error());
  }
  auto result = body();
  if (const auto ended = database().end_reads(); !ended && result) {
    return failed(ended.error());
  }
  return result;
}

}  // namespace runstone
