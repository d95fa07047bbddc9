#include "server/store/chunk_table.hpp"

#include <array>

#include "common/core/key_text.hpp"
#include "protocol/chunks/chunk_codec.hpp"
#include "server/store/chunk_row.hpp"
#include "server/store/loss_advice.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {

namespace {

/// Takes the columns as they are stored, before they are cut to the types of a key: a cut could
/// hide damage.
std::uint64_t fold_term(const std::array<std::int64_t, 6>& columns) {
  RowChecksum sum("fold");
  for (const std::int64_t column : columns) sum.integer(column);
  return static_cast<std::uint64_t>(sum.value());
}

std::uint64_t fold_term(const ChunkKey& key, const Version& version) {
  return fold_term({key.lod, key.at.x, key.at.y, key.at.z, version.epoch,
                    static_cast<std::int64_t>(version.seq)});
}

}  // namespace

StoreResult<ChunkTable> ChunkTable::open(sql::Database& database, Kind kind) {
  const std::string table = kind == Kind::snapshot ? "snapshot" : "base";
  const std::string where = " FROM " + table + " WHERE lod = ?1 AND x = ?2 AND y = ?3 AND z = ?4";
  auto load = database.prepare("SELECT epoch, seq, digest0, digest1, checksum, data" + where +
                               " AND seq <= ?5");
  if (!load) return failed(load.error());
  auto rows = database.prepare("SELECT lod, x, y, z, epoch, seq, digest0, digest1 FROM " + table +
                               " ORDER BY lod, x, y, z");
  if (!rows) return failed(rows.error());
  auto version = database.prepare("SELECT epoch, seq" + where);
  if (!version) return failed(version.error());
  auto save = database.prepare(save_chunk_text(table));
  if (!save) return failed(save.error());
  return ChunkTable(database.file(), kind, table, *std::move(load), *std::move(rows),
                    *std::move(version), *std::move(save));
}

Unexpected<StoreError> ChunkTable::chunk_failure(StoreError::Kind kind, const ChunkKey& key,
                                                 std::string what) const {
  return {{kind, file_, table_ + " chunk=" + text_of(key), std::move(what)}};
}

StoreResult<std::optional<Chunk>> ChunkTable::load(const ChunkKey& key, Sequence last,
                                                   std::uint16_t chunk_edge, RowCheck check) {
  const sql::ResetAtEnd reset_at_end(load_);
  bind_key(load_, key);
  const auto found = load_.bind(5, static_cast<std::int64_t>(last)).step();
  if (!found) return failed(found.error());
  if (!*found) return std::optional<Chunk>();
  auto chunk = chunk_of(
      table_, {key, version_at(load_, 0), digest_at(load_, 2), load_.integer(4), load_.blob(5)},
      chunk_edge, check);
  if (!chunk) return chunk_failure(StoreError::Kind::corrupt, key, chunk.error());
  return std::optional<Chunk>(*std::move(chunk));
}

StoreResult<RowFold> ChunkTable::read_rows(const std::function<void(const StoredChunk&)>& each) {
  const sql::ResetAtEnd reset_at_end(rows_);
  RowFold fold;
  for (;;) {
    const auto more = rows_.step();
    if (!more) return failed(more.error());
    if (!*more) return fold;
    ++fold.count;
    fold.sum += fold_term({rows_.integer(0), rows_.integer(1), rows_.integer(2), rows_.integer(3),
                           rows_.integer(4), rows_.integer(5)});
    each({key_at(rows_, 0), version_at(rows_, 4), digest_at(rows_, 6), kind_ == Kind::base});
  }
}

StoreResult<std::vector<ChunkKey>> ChunkTable::keys(sql::Database& database,
                                                    const std::optional<ChunkKey>& behind,
                                                    std::size_t count) const {
  // The index of the key has these columns, so no row of the table is read.
  const std::string where = behind ? " WHERE (lod, x, y, z) > (?1, ?2, ?3, ?4)" : "";
  auto row = database.prepare("SELECT lod, x, y, z FROM " + table_ + where +
                              " ORDER BY lod, x, y, z LIMIT " + std::to_string(count));
  if (!row) return failed(row.error());
  if (behind) bind_key(*row, *behind);
  std::vector<ChunkKey> keys;
  for (;;) {
    const auto more = row->step();
    if (!more) return failed(more.error());
    if (!*more) return keys;
    const ChunkKey key = key_at(*row, 0);
    const bool is_cut = key.lod != row->integer(0) || key.at.x != row->integer(1) ||
                        key.at.y != row->integer(2) || key.at.z != row->integer(3);
    if (is_cut) return chunk_failure(StoreError::Kind::corrupt, key, "has an impossible key");
    keys.push_back(key);
  }
}

StoreResult<RowFold> ChunkTable::fold() {
  return read_rows([](const StoredChunk&) {});
}

StoreResult<std::vector<StoredChunk>> ChunkTable::rows(const RowFold& expected) {
  std::vector<StoredChunk> rows;
  const auto fold = read_rows([&](const StoredChunk& row) { rows.push_back(row); });
  if (!fold) return failed(fold.error());
  if (*fold == expected) return rows;
  return failure(StoreError{
      StoreError::Kind::corrupt, file_, table_,
      "rows vanished, appeared or changed their key or version: " + std::to_string(fold->count) +
          " rows, meta counts " + std::to_string(expected.count) + ". " + kLossAdvice +
          (kind_ == Kind::snapshot ? ", which makes the snapshots again: no edit is lost" : "")});
}

StoreResult<void> ChunkTable::save(const ChunkKey& key, const Chunk& chunk,
                                   std::uint16_t chunk_edge, RowFold& fold) {
  if (const std::string what = unfit(chunk, chunk_edge); !what.empty())
    return chunk_failure(StoreError::Kind::bad_request, key, what);
  std::optional<Version> stored;
  {
    const sql::ResetAtEnd reset_at_end(version_);
    bind_key(version_, key);
    const auto found = version_.step();
    if (!found) return failed(found.error());
    if (*found) stored = version_at(version_, 0);
  }
  if (stored && kind_ == Kind::base && chunk.version == *stored) {
    return chunk_failure(StoreError::Kind::bad_request, key, "is there already");
  }
  if (stored && chunk.version < *stored) {
    return chunk_failure(StoreError::Kind::bad_request, key, "is older than the stored version");
  }
  const Bytes data = encode_chunk(chunk.voxels, ChunkEncoding::packed);
  bind_key(save_, key);
  save_.bind(5, std::int64_t{chunk.version.epoch})
      .bind(6, static_cast<std::int64_t>(chunk.version.seq))
      .bind(7, static_cast<std::int64_t>(chunk.digest.lane[0]))
      .bind(8, static_cast<std::int64_t>(chunk.digest.lane[1]))
      .bind(9, checksum_of(table_, {key, chunk.version, chunk.digest, 0, data}))
      .bind(10, ByteView(data));
  if (auto saved = save_.run(); !saved) return failed(saved.error());
  if (stored) fold.sum -= fold_term(key, *stored);
  fold.count += stored ? 0 : 1;
  fold.sum += fold_term(key, chunk.version);
  return {};
}

}  // namespace runstone
