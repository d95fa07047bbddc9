// ModelStore: a connection of one program with the ModelDatabase, as a Store. Whoever has the lease
// may write. It knows what servers of one world call: no keyframes, tiles, imports or compactions.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/store/store.hpp"
#include "tests/simulation/server/world/model_database.hpp"

namespace runstone::test {

class ModelStore final : public Store {
 public:
  /// `term`: of the lease; nullopt: the connection reads only. All must outlive the object.
  ModelStore(ModelDatabase& database, const WorldMeta& meta, std::optional<LeaseTerm> term = {})
      : database_(database), meta_(meta), term_(term) {}

  const WorldMeta& meta() const override { return meta_; }
  const std::string& file() const override { return file_; }

  StoreResult<LogRange> log_range() override {
    LogRange range;
    if (!database_.log().empty()) {
      const EditRecord& last = database_.log().back();
      range.last = {last.version, last.time_us};
    }
    return range;
  }
  StoreResult<LogEnd> log_head() override { return LogEnd{}; }
  StoreResult<void> read_log(Sequence first, Sequence last, const EachRecord& each) override {
    const auto& log = database_.log();
    for (Sequence seq = std::max<Sequence>(first, 1); seq <= std::min<Sequence>(last, log.size());
         ++seq) {
      if (!each(log[seq - 1])) break;
    }
    return {};
  }
  StoreResult<void> query_log(const LogQuery& query, const EachRecord& each) override {
    return read_log(query.first, query.last, [&](const EditRecord& record) {
      return !overlaps(bounding_box(record.edit), *query.box) || each(record);
    });
  }
  StoreResult<void> rows_of_author(AuthorId author, Sequence last, const EachRow& each) override {
    const auto& log = database_.log();
    for (Sequence seq = std::min<Sequence>(last, log.size()); seq > 0; --seq) {
      const EditRecord& record = log[seq - 1];
      if (record.op.author != author) continue;
      if (!each({record.version, record.op, record.cause, record.subject})) break;
    }
    return {};
  }
  StoreResult<void> read_rights(const EachRecord& each) override {
    for (const EditRecord& record : database_.log()) {
      if (rights_change_of(record.edit) != nullptr && !each(record)) break;
    }
    return {};
  }
  StoreResult<void> read_textures(const EachRecord& each) override {
    for (const EditRecord& record : database_.log()) {
      if (given_texture_of(record.edit) != nullptr && !each(record)) break;
    }
    return {};
  }
  using LogReader::materials;
  StoreResult<MaterialTable> materials(Sequence /*at*/) override { return meta_.materials; }

  void set_row_check(RowCheck /*check*/) override {}
  using ChunkReader::load_snapshot;
  StoreResult<std::optional<Chunk>> load_snapshot(const ChunkKey& key, Sequence last) override {
    const auto found = database_.snapshots().find(key);
    if (found == database_.snapshots().end() || found->second.version.seq > last)
      return std::optional<Chunk>();
    return std::optional(found->second);
  }
  StoreResult<std::vector<std::pair<ChunkKey, Version>>> snapshot_keys() override {
    std::vector<std::pair<ChunkKey, Version>> keys;
    for (const auto& [key, chunk] : database_.snapshots()) keys.emplace_back(key, chunk.version);
    return keys;
  }
  StoreResult<Sequence> checkpoint() override { return database_.checkpoint(); }

  StoreResult<std::vector<PlayerRow>> players() override {
    std::vector<PlayerRow> rows;
    for (const auto& [author, row] : database_.players()) rows.push_back(row);
    return rows;
  }
  StoreResult<std::vector<UsedName>> player_names() override { return std::vector<UsedName>(); }
  StoreResult<std::vector<NameClaim>> name_claims() override {
    std::vector<NameClaim> claims;
    for (const auto& [folded, claim] : database_.names()) claims.push_back(claim);
    return claims;
  }
  StoreResult<std::vector<HighWater>> high_waters() override {
    std::map<std::pair<AuthorId, ClientInstance>, HighWater> marks;
    if (!database_.is_there(Protection::watermarks)) return std::vector<HighWater>();
    for (const EditRecord& record : database_.log()) {
      const OperationId& op = record.op;
      HighWater& mark = marks[{op.author, op.instance}];
      mark = {op.author, op.instance, std::max(mark.resolved, op.seq), record.time_us};
    }
    std::vector<HighWater> all;
    for (const auto& [client, mark] : marks) all.push_back(mark);
    return all;
  }
  AuthorId author_max() const override {
    return database_.players().empty() ? 0 : database_.players().rbegin()->first;
  }

  StoreResult<std::vector<LastPlace>> saved_places() override { return std::vector<LastPlace>(); }
  StoreResult<std::optional<SavedClock>> saved_clock() override {
    return std::optional<SavedClock>();
  }
  const std::optional<StoreError>& loss() const override { return loss_; }
  StoreResult<void> begin_reads() override { return {}; }
  StoreResult<void> end_reads() override { return {}; }
  StoreResult<void> check() override { return {}; }

  StoreResult<void> append(std::span<const PlayerRow> players,
                           std::span<const EditRecord> records) override {
    if (auto may = may_write(); !may) return may;
    database_.append(*term_, players, records);
    return {};
  }
  StoreResult<void> save_state(const SavedState& /*state*/) override { return may_write(); }
  StoreResult<void> append_history(std::span<const PlayerRow> players,
                                   std::span<const EditRecord> records) override {
    return append(players, records);
  }
  StoreResult<void> change_names(std::span<const NameChange> changes) override {
    if (auto may = may_write(); !may) return may;
    database_.change_names(*term_, changes);
    return {};
  }
  StoreResult<Epoch> raise_epoch() override {
    if (const auto may = may_write(); !may) return failure(may.error());
    return database_.raise_epoch(*term_);
  }
  Epoch epoch() const override { return database_.epoch(); }

  // The servers of a simulation never call these functions. Each throws SimFault.
  StoreResult<Sequence> sequence_at(TimeUs /*time_us*/) override { return no<Sequence>(); }
  StoreResult<bool> has_base() override { return no<bool>(); }
  StoreResult<std::optional<Chunk>> load_base(const ChunkKey& /*key*/) override {
    return no<std::optional<Chunk>>();
  }
  StoreResult<std::vector<StoredChunk>> base_chunks() override {
    return no<std::vector<StoredChunk>>();
  }
  StoreResult<std::optional<Chunk>> load_tile(const ChunkKey& /*key*/,
                                              std::uint32_t /*rules*/) override {
    return no<std::optional<Chunk>>();
  }
  StoreResult<std::vector<std::pair<ChunkKey, Version>>> tile_keys(
      std::uint32_t /*rules*/) override {
    return no<std::vector<std::pair<ChunkKey, Version>>>();
  }
  StoreResult<std::vector<std::string>> rows_of_no_tile() override {
    return no<std::vector<std::string>>();
  }
  StoreResult<std::vector<Keyframe>> keyframes() override { return no<std::vector<Keyframe>>(); }
  StoreResult<std::vector<StoredChunk>> keyframe_chunks() override {
    return no<std::vector<StoredChunk>>();
  }
  StoreResult<StoredMoment> stored_moment(Sequence /*at*/) override { return no<StoredMoment>(); }
  StoreResult<std::optional<Chunk>> load_stored(const StoredChunk& /*chunk*/) override {
    return no<std::optional<Chunk>>();
  }
  StoreResult<std::optional<Chunk>> load_kept(const ChunkKey& /*key*/, Sequence /*at*/) override {
    return no<std::optional<Chunk>>();
  }
  StoreResult<void> save_snapshots(ChunkSpan /*chunks*/,
                                   std::optional<Sequence> /*checkpoint*/) override {
    return no<void>();
  }
  StoreResult<void> save_keyframe(ChunkSpan /*chunks*/,
                                  const std::optional<Keyframe>& /*keyframe*/) override {
    return no<void>();
  }
  StoreResult<void> save_tiles(ChunkSpan /*tiles*/, std::uint32_t /*rules*/) override {
    return no<void>();
  }
  StoreResult<void> save_base(ChunkSpan /*chunks*/) override { return no<void>(); }
  StoreResult<void> compact(Sequence /*keyframe*/) override { return no<void>(); }
  StoreResult<std::vector<ChunkKey>> chunk_keys(ChunkRows /*rows*/,
                                                const std::optional<ChunkKey>& /*behind*/,
                                                std::size_t /*count*/) override {
    return no<std::vector<ChunkKey>>();
  }
  StoreResult<void> shrink() override { return no<void>(); }
  StoreResult<Epoch> begin_branch(TimeUs /*now_us*/) override { return no<Epoch>(); }
  StoreResult<std::vector<std::string>> accept_losses() override {
    return no<std::vector<std::string>>();
  }

 private:
  template <class T>
  [[noreturn]] static StoreResult<T> no() {
    throw SimFault("the model of the database does not know this call");
  }
  StoreResult<void> may_write() const {
    if (database_.is_disk_full)
      return failure(StoreError{StoreError::Kind::full, file_, "", "no space is left"});
    if (term_ && database_.may_write(*term_)) return {};
    return failure(StoreError{StoreError::Kind::locked, file_, "lease",
                              "another server has taken this world over"});
  }

  ModelDatabase& database_;
  const WorldMeta& meta_;
  const std::optional<LeaseTerm> term_;
  const std::string file_ = "model";
  const std::optional<StoreError> loss_;
};

}  // namespace runstone::test
