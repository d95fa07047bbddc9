// Store::check() over SQLite: every row of every table, and what the tables promise each other.
#include <map>
#include <utility>

#include "server/store/sqlite_store.hpp"

namespace runstone {

StoreResult<void> SqliteStore::check_chunks(ChunkTable& table) {
  const auto keys = keys_of(table);
  if (!keys) return Unexpected<StoreError>{keys.error()};
  const auto last = log_.last();
  if (!last) return Unexpected<StoreError>{last.error()};
  for (const auto& [key, version] : *keys) {
    const auto chunk = table.load(key, meta_.chunk_edge);
    if (!chunk) return Unexpected<StoreError>{chunk.error()};
    if (version > last->value_or(Version{})) {
      return Unexpected<StoreError>{{StoreError::Kind::corrupt, file(), "snapshot chunk=" + name_of(key),
                                     "is newer than the end of the log"}};
    }
  }
  return {};
}

StoreResult<void> SqliteStore::check_marks_cover_log() {
  const auto rows = player_table_.high_waters();
  if (!rows) return Unexpected<StoreError>{rows.error()};
  std::map<std::pair<AuthorId, ClientInstance>, ClientSequence> marks;
  for (const HighWater& row : *rows) marks[{row.author, row.instance}] = row.decided;
  const auto last = last_sequence();
  if (!last) return Unexpected<StoreError>{last.error()};
  std::optional<OperationId> uncovered;
  auto read = log_.read(1, *last, [&](const EditRecord& record) {
    const auto mark = marks.find({record.op.author, record.op.instance});
    if (mark == marks.end() || mark->second < record.op.seq) uncovered = record.op;
    return !uncovered.has_value();
  });
  if (!read || !uncovered) return read;
  return Unexpected<StoreError>{
      {StoreError::Kind::corrupt, file(),
       "player_instance author=" + std::to_string(uncovered->author) +
           " instance=" + std::to_string(uncovered->instance),
       "is behind the log, which holds client edit " + std::to_string(uncovered->seq)}};
}

StoreResult<void> SqliteStore::check() {
  const auto verdict = database_->text("PRAGMA integrity_check(1)");
  if (!verdict) return Unexpected<StoreError>{verdict.error()};
  if (*verdict != "ok")
    return Unexpected<StoreError>{{StoreError::Kind::corrupt, file(), "database", *verdict}};
  if (const auto rows = meta_table_.read_all(); !rows) return Unexpected<StoreError>{rows.error()};
  if (const auto rows = player_table_.players(); !rows) return Unexpected<StoreError>{rows.error()};
  if (const auto seq = checkpoint(); !seq) return Unexpected<StoreError>{seq.error()};
  if (auto marks = check_marks_cover_log(); !marks) return marks;
  if (auto chunks = check_chunks(base_); !chunks) return chunks;
  return check_chunks(snapshots_);
}

}  // namespace runstone
