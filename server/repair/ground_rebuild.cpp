#include "server/repair/ground_rebuild.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/restore/restore.hpp"
#include "common/runs/reorder.hpp"
#include "common/sql/transaction.hpp"
#include "common/sqlite/sqlite_file.hpp"
#include "server/history/base_chunk.hpp"
#include "server/rollback/restore_paste.hpp"
#include "server/store/meta_table.hpp"
#include "server/store/sql_result.hpp"

namespace runstone {
namespace {

constexpr std::size_t kChunksAtOnce = 256;
constexpr Sequence kProgressEdits = 1024;

}  // namespace

GroundRebuild::GroundRebuild(Store& store, const Generator& generator)
    : store_(store), generator_(generator), edge_(store.meta().chunk_edge) {}

StoreResult<ReplayedChunk*> GroundRebuild::chunk_of(const ChunkKey& key) {
  auto found = chunks_.find(key);
  if (found == chunks_.end()) {
    auto base = base_chunk(store_, generator_, key);
    if (!base) return failure(base.error());
    found = chunks_.emplace(key, ReplayedChunk(*std::move(base), origin_of(key.at, edge_))).first;
  }
  return &found->second;
}

void GroundRebuild::add(const EditRecord& record, const ChunkKey& key) {
  chunks_.at(key).add(record.edit, record.version, scratch_);
  if (const auto shown = shown_.find(key); shown != shown_.end())
    shown->second.add(record.edit, record.version, scratch_);
}

StoreResult<void> GroundRebuild::compare(const ChunkKey& key) {
  const auto chunk = chunk_of(key);
  if (!chunk) return failure(chunk.error());
  (*chunk)->flush(scratch_);
  auto snapshot = store_.load_snapshot(key);
  if (!snapshot) return failure(snapshot.error());
  if (!snapshot->has_value() || (*snapshot)->digest == (*chunk)->chunk().digest) return {};
  shown_.emplace(key, ReplayedChunk(**std::move(snapshot), origin_of(key.at, edge_)));
  return {};
}

StoreResult<void> GroundRebuild::read(const std::function<void(Sequence, Sequence)>& on_progress) {
  const auto range = store_.log_range();
  if (!range) return failure(range.error());
  const auto keys = store_.snapshot_keys();
  if (!keys) return failure(keys.error());
  std::multimap<Sequence, ChunkKey> snapshots;
  for (const auto& [key, version] : *keys) snapshots.emplace(version.seq, key);
  auto next = snapshots.begin();
  const auto compare_up_to = [&](Sequence seq) -> StoreResult<void> {
    for (; next != snapshots.end() && next->first <= seq; ++next) {
      if (auto compared = compare(next->second); !compared) return compared;
    }
    return {};
  };
  if (const auto base = store_.base_chunks(); !base) {
    return failure(base.error());
  } else {
    // Chunks whose edits were all compacted into the base belong to the world, too.
    for (const StoredChunk& row : *base) {
      if (row.version == Version{}) continue;
      if (const auto chunk = chunk_of(row.key); !chunk) return failure(chunk.error());
    }
  }
  if (auto compared = compare_up_to(range->first - 1); !compared) return compared;
  StoreResult<void> followed;
  const auto read = store_.read_log(1, kSequenceMax, [&](const EditRecord& record) {
    for (const ChunkCoord at : touched_chunks(record.edit, edge_)) {
      const ChunkKey key{0, at};
      if (const auto chunk = chunk_of(key); !chunk) {
        followed = failure(chunk.error());
        return false;
      }
      add(record, key);
    }
    followed = compare_up_to(record.version.seq);
    if (on_progress && record.version.seq % kProgressEdits == 0)
      on_progress(record.version.seq, range->last.version.seq);
    return followed.has_value();
  });
  if (!read) return read;
  return followed;
}

std::vector<EditDescriptor> GroundRebuild::missing_edits(std::vector<KeptGround>& ground) {
  std::vector<EditDescriptor> edits;
  for (auto& [key, shown] : shown_) {
    ReplayedChunk& chunk = chunks_.at(key);
    chunk.flush(scratch_);
    shown.flush(scratch_);
    const RunChunk& now = chunk.chunk().voxels;
    std::vector<Difference> differences;
    append_differences(now, reorder(shown.chunk().voxels, now.order), differences);
    if (differences.empty()) continue;
    std::uint64_t voxels = 0;
    for (const Difference& difference : differences) voxels += difference.last - difference.first;
    ground.push_back({key, voxels});
    auto pastes = restore_pastes(now, differences, origin_of(key.at, edge_));
    edits.insert(edits.end(), std::make_move_iterator(pastes.begin()),
                 std::make_move_iterator(pastes.end()));
  }
  shown_.clear();
  return edits;
}

void GroundRebuild::follow(const std::vector<EditRecord>& records) {
  for (const EditRecord& record : records) {
    // Each edit is within one chunk, which has been read.
    for (const ChunkCoord at : touched_chunks(record.edit, edge_)) add(record, {0, at});
  }
}

StoreResult<void> GroundRebuild::save(Store& store) {
  const auto last = store.last_sequence();
  if (!last) return failure(last.error());
  std::vector<std::pair<ChunkKey, ChunkPtr>> part;
  for (auto& [key, chunk] : chunks_) {
    chunk.flush(scratch_);
    if (chunk.chunk().version == Version{}) continue;
    part.emplace_back(key, std::make_shared<const Chunk>(std::move(chunk.chunk())));
    if (part.size() < kChunksAtOnce) continue;
    if (auto saved = store.save_snapshots(part, std::nullopt); !saved) return saved;
    part.clear();
  }
  return store.save_snapshots(part, *last);
}

StoreResult<void> forget_snapshots(const std::string& folder) {
  auto database = sql::open_sqlite(folder + "/world.sqlite", sql::SqliteMode::write);
  if (!database) return failed(database.error());
  auto meta = MetaTable::open(*database);
  if (!meta) return failed(meta.error());
  auto transaction = sql::Transaction::begin(*database);
  if (!transaction) return failed(transaction.error());
  if (const auto gone = database->run("DELETE FROM snapshot"); !gone) return failed(gone.error());
  if (auto put = meta->put_fold("snapshot_fold", {}); !put) return put;
  return store_result(transaction->commit());
}

}  // namespace runstone
