#include "server/repair/backup_rows.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "server/history/world_at.hpp"
#include "server/store/chunk_table.hpp"
#include "server/store/claim_table.hpp"
#include "server/store/kept_records.hpp"
#include "server/store/log_table.hpp"
#include "server/store/name_table.hpp"
#include "server/store/player_table.hpp"
#include "server/store/record_checksum.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/world_folder.hpp"

namespace runstone {
namespace {

/// Calls `take` for the rows, and returns how often it returned true. Fails as `rows` and `take`.
template <class Row, class Take>
StoreResult<std::uint64_t> take_rows(const StoreResult<std::vector<Row>>& rows, Take take) {
  if (!rows) return failed(rows.error());
  std::uint64_t taken = 0;
  for (const Row& row : *rows) {
    const StoreResult<bool> is_taken = take(row);
    if (!is_taken) return failed(is_taken.error());
    taken += *is_taken ? 1 : 0;
  }
  return taken;
}

template <class T>
StoreResult<bool> is_written(const StoreResult<T>& written) {
  if (!written) return failed(written.error());
  return true;
}

}  // namespace

Result<BackupRows, std::string> BackupRows::open(const std::string& folder) {
  auto store = open_world(folder, StoreAccess::read_only);
  if (!store) return failure(store.error().message());
  std::string fault;
  if ((*store)->loss()) {
    fault = (*store)->loss()->message();
  } else if (const auto sound = (*store)->check(); !sound) {
    fault = sound.error().message();
  }
  if (!fault.empty()) {
    return failure("the backup is damaged, too: " + fault +
                   ". Take an older one, or repair this one first");
  }
  auto generator = generator_of(**store);
  if (!generator) return failure(generator.error());
  return BackupRows(*std::move(store), *std::move(generator));
}

StoreResult<std::uint64_t> BackupRows::fill_log(sql::Database& database, const LogEnd& head,
                                                Epoch epoch) {
  const auto range = store_->log_range();
  if (!range) return failed(range.error());
  auto log = LogTable::open(database);
  if (!log) return failed(log.error());
  auto one = database.prepare("SELECT epoch, checksum FROM edit_log WHERE log = 0 AND seq = ?1");
  if (!one) return failed(one.error());
  auto next = database.prepare(
      "SELECT epoch FROM edit_log WHERE log = 0 AND seq > ?1 ORDER BY seq LIMIT 1");
  if (!next) return failed(next.error());
  // The edits that the backup has compacted are taken for common, until a record shows that they
  // are not. Their authors are known only if the log of the backup has no records.
  common_ = range->first - 1;
  author_max_ = range->last.version.seq == common_ ? store_->author_max() : 0;
  std::vector<EditRecord> taken;
  Epoch before = head.version.epoch;
  StoreResult<void> filled;
  const auto read = store_->read_log(1, range->last.version.seq, [&](const EditRecord& record) {
    const sql::ResetAtEnd reset_one_at_end(*one);
    const auto seq = static_cast<std::int64_t>(record.version.seq);
    const auto there = one->bind(1, seq).step();
    if (!there) filled = failed(there.error());
    if (!there) return false;
    bool is_common = record.version.seq <= head.version.seq;
    if (record.version.seq == head.version.seq && record.version != head.version) {
      // The world has compacted another edit of this number: nothing is common.
      common_ = 0;
      author_max_ = 0;
      return false;
    }
    if (*there) {
      is_common = one->integer(0) == std::int64_t{record.version.epoch} &&
                  one->integer(1) == static_cast<std::int64_t>(record_checksum(record));
    } else if (!is_common) {
      const sql::ResetAtEnd reset_next_at_end(*next);
      const auto behind = next->bind(1, seq).step();
      if (!behind) filled = failed(behind.error());
      if (!behind) return false;
      const std::int64_t newest = *behind ? next->integer(0) : std::int64_t{epoch};
      is_common = record.version.epoch >= before && record.version.epoch <= newest;
      if (is_common) taken.push_back(record);
    }
    if (!is_common) return false;
    before = record.version.epoch;
    common_ = record.version.seq;
    author_max_ = std::max(author_max_, record.op.author);
    return true;
  });
  if (!read) return failed(read.error());
  if (!filled) return failed(filled.error());
  if (auto inserted = log->insert(taken); !inserted) return failed(inserted.error());
  return taken.size();
}

StoreResult<std::uint64_t> BackupRows::fill_base(sql::Database& database, const LogEnd& head) {
  const auto own_head = store_->log_head();
  if (!own_head) return failed(own_head.error());
  const Sequence at = head.version.seq;
  if (own_head->version.seq > at || common_ < at) return std::uint64_t{0};
  auto past = WorldAt::open(*store_, *generator_, at);
  if (!past) return failed(past.error());
  std::set<ChunkKey> keys;
  for (const ChunkKey& key : past->edited()) keys.insert(key);
  const auto imported = store_->base_chunks();
  if (!imported) return failed(imported.error());
  for (const StoredChunk& row : *imported) keys.insert(row.key);
  auto table = ChunkTable::open(database, ChunkTable::Kind::base);
  if (!table) return failed(table.error());
  const std::uint16_t edge = store_->meta().chunk_edge;
  std::uint64_t taken = 0;
  RowFold unused;
  for (const ChunkKey& key : keys) {
    // Before the first compaction the base has imported chunks alone.
    if (at == 0 && past->version(key) != Version{}) continue;
    const auto there = table->load(key, kSequenceMax, edge, RowCheck::bytes);
    if (!there) return failed(there.error());
    if (there->has_value()) continue;
    const auto chunk = past->chunk(key);
    if (!chunk) return failed(chunk.error());
    if (auto saved = table->save(key, *chunk, edge, unused); !saved) return failed(saved.error());
    ++taken;
  }
  return taken;
}

StoreResult<std::uint64_t> BackupRows::fill_kept_records(sql::Database& database,
                                                         const LogEnd& head) {
  auto table = KeptRecords::open(database);
  if (!table) return failed(table.error());
  const auto there = table->records();
  if (!there) return failed(there.error());
  std::set<Sequence> known;
  for (const EditRecord& record : there->rows) known.insert(record.version.seq);
  std::uint64_t taken = 0;
  RowFold unused;
  StoreResult<void> filled;
  const auto take = [&](const EditRecord& record) {
    const Sequence seq = record.version.seq;
    if (seq > head.version.seq || seq > common_) return false;
    if (!known.insert(seq).second) return true;
    filled = table->add(record, unused);
    taken += filled ? 1 : 0;
    return filled.has_value();
  };
  if (const auto read = store_->read_rights(take); !read) return failed(read.error());
  if (const auto read = store_->read_textures(take); !read) return failed(read.error());
  if (!filled) return failed(filled.error());
  return taken;
}

StoreResult<std::uint64_t> BackupRows::fill_players(sql::Database& database) {
  auto table = PlayerTable::open(database);
  if (!table) return failed(table.error());
  const auto there = table->players();
  if (!there) return failed(there.error());
  RowFold unused;
  return take_rows(store_->players(), [&](const PlayerRow& player) -> StoreResult<bool> {
    const bool is_known = std::ranges::any_of(there->rows, [&](const PlayerRow& row) {
      return row.author == player.author || row.key == player.key;
    });
    if (is_known || !is_common(player.author)) return false;
    return is_written(table->put(player, unused));
  });
}

StoreResult<std::uint64_t> BackupRows::fill_names(sql::Database& database) {
  auto table = NameTable::open(database);
  if (!table) return failed(table.error());
  const auto there = table->names();
  if (!there) return failed(there.error());
  std::set<AuthorId> known;
  for (const UsedName& name : *there) known.insert(name.author);
  return take_rows(store_->player_names(), [&](const UsedName& name) -> StoreResult<bool> {
    if (known.contains(name.author) || !is_common(name.author)) return false;
    return is_written(table->add(name));
  });
}

StoreResult<std::uint64_t> BackupRows::fill_claims(sql::Database& database) {
  auto table = ClaimTable::open(database);
  if (!table) return failed(table.error());
  RowFold unused;
  return take_rows(store_->name_claims(), [&](const NameClaim& claim) -> StoreResult<bool> {
    const auto owner = table->owner(claim.folded);
    if (!owner) return failed(owner.error());
    if (*owner) return false;
    return is_written(table->add(claim, unused));
  });
}

StoreResult<std::uint64_t> BackupRows::fill_watermarks(sql::Database& database) {
  auto table = PlayerTable::open(database);
  if (!table) return failed(table.error());
  const auto before = table->high_waters();
  if (!before) return failed(before.error());
  RowFold unused;
  const auto taken = take_rows(store_->high_waters(), [&](const HighWater& mark) {
    return is_common(mark.author) ? is_written(table->raise(mark, unused))
                                  : StoreResult<bool>(false);
  });
  if (!taken) return failed(taken.error());
  const auto after = table->high_waters();
  if (!after) return failed(after.error());
  return after->rows.size() - before->rows.size();
}

}  // namespace runstone
