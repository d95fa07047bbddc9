#include "server/store/tile_table.hpp"

#include <algorithm>

#include "common/core/key_text.hpp"
#include "common/core/tile_keys.hpp"
#include "protocol/chunks/chunk_codec.hpp"
#include "server/store/chunk_row.hpp"
#include "server/store/sql_result.hpp"

namespace runstone {
namespace {

constexpr const char* kTable = "tile";

/// True of rows whose key fits its types. The key of another one would be cut to that of a tile.
std::string has_key() {
  constexpr const char* kFits = " BETWEEN -2147483648 AND 2147483647";
  return "(lod BETWEEN 1 AND " + std::to_string(kTileLevelMax) + " AND x" + kFits + " AND y" +
         kFits + " AND z" + kFits + ")";
}

/// Returns a condition in SQL: the tiles were made by the rules that the parameter names. One
/// statement reads the row and the rules at one moment, because another program may replace both.
std::string has_rules(const sql::Database& database, const std::string& parameter) {
  const char* const value = database.dialect() == sql::Dialect::sqlite ? "value" : "integer_value";
  return parameter + " = (SELECT " + value + " FROM meta WHERE key = 'tile_rules')";
}

}  // namespace

StoreResult<TileTable> TileTable::open(sql::Database& database) {
  const std::string where = " WHERE lod = ?1 AND x = ?2 AND y = ?3 AND z = ?4";
  auto load = database.prepare("SELECT epoch, seq, digest0, digest1, checksum, data FROM tile" +
                               where + " AND " + has_rules(database, "?5"));
  if (!load) return failed(load.error());
  auto keys = database.prepare("SELECT lod, x, y, z, epoch, seq FROM tile WHERE " + has_key() +
                               " AND " + has_rules(database, "?1") + " ORDER BY lod, x, y, z");
  if (!keys) return failed(keys.error());
  auto no_tile = database.prepare(
      "SELECT 'lod=' || lod || ' x=' || x || ' y=' || y || ' z=' || z FROM tile WHERE NOT " +
      has_key());
  if (!no_tile) return failed(no_tile.error());
  auto save = database.prepare(save_chunk_text(std::string(kTable)));
  if (!save) return failed(save.error());
  auto remove_older = database.prepare("DELETE FROM tile" + where + " AND (epoch, seq) < (?5, ?6)");
  if (!remove_older) return failed(remove_older.error());
  auto clear = database.prepare("DELETE FROM tile");
  if (!clear) return failed(clear.error());
  return TileTable(database.file(),
                   {*std::move(load), *std::move(keys), *std::move(no_tile), *std::move(save),
                    *std::move(remove_older), *std::move(clear)});
}

Unexpected<StoreError> TileTable::tile_failure(StoreError::Kind kind, const ChunkKey& key,
                                               std::string what) const {
  return {{kind, file_, std::string(kTable) + " chunk=" + text_of(key), std::move(what)}};
}

StoreResult<std::optional<Chunk>> TileTable::load(const ChunkKey& key, std::uint32_t rules,
                                                  std::uint16_t chunk_edge, RowCheck check) {
  const sql::ResetAtEnd reset_at_end(s_.load);
  bind_key(s_.load, key);
  s_.load.bind(5, std::int64_t{rules});
  const auto found = s_.load.step();
  if (!found) return failed(found.error());
  if (!*found) return std::optional<Chunk>();
  auto tile = chunk_of(
      kTable,
      {key, version_at(s_.load, 0), digest_at(s_.load, 2), s_.load.integer(4), s_.load.blob(5)},
      chunk_edge, check);
  if (!tile) return tile_failure(StoreError::Kind::corrupt, key, tile.error());
  return std::optional<Chunk>(*std::move(tile));
}

StoreResult<std::vector<std::pair<ChunkKey, Version>>> TileTable::keys(std::uint32_t rules) {
  const sql::ResetAtEnd reset_at_end(s_.keys);
  s_.keys.bind(1, std::int64_t{rules});
  std::vector<std::pair<ChunkKey, Version>> keys;
  for (;;) {
    const auto more = s_.keys.step();
    if (!more) return failed(more.error());
    if (!*more) return keys;
    keys.emplace_back(key_at(s_.keys, 0), version_at(s_.keys, 4));
  }
}

StoreResult<std::vector<std::string>> TileTable::rows_of_no_tile() {
  const sql::ResetAtEnd reset_at_end(s_.no_tile);
  std::vector<std::string> rows;
  for (;;) {
    const auto more = s_.no_tile.step();
    if (!more) return failed(more.error());
    if (!*more) return rows;
    rows.push_back(file_ + ": " + kTable + " " + std::string(s_.no_tile.text(0)) +
                   ": is the key of no tile");
  }
}

StoreResult<void> TileTable::save(const ChunkKey& key, const Chunk& tile,
                                  std::uint16_t chunk_edge) {
  if (key.lod == 0 || key.lod > kTileLevelMax)
    return tile_failure(StoreError::Kind::bad_request, key, "is of no level of tiles");
  if (const std::string what = unfit(tile, chunk_edge); !what.empty())
    return tile_failure(StoreError::Kind::bad_request, key, what);
  if (const auto newest = newest_below_.find(key);
      newest != newest_below_.end() && tile.version < newest->second)
    return {};
  const Bytes data = encode_chunk(tile.voxels, ChunkEncoding::packed);
  bind_key(s_.save, key);
  s_.save.bind(5, std::int64_t{tile.version.epoch})
      .bind(6, static_cast<std::int64_t>(tile.version.seq))
      .bind(7, static_cast<std::int64_t>(tile.digest.lane[0]))
      .bind(8, static_cast<std::int64_t>(tile.digest.lane[1]))
      .bind(9, checksum_of(kTable, {key, tile.version, tile.digest, 0, data}))
      .bind(10, ByteView(data));
  return store_result(s_.save.run());
}

StoreResult<void> TileTable::remove_stale(std::span<const std::pair<ChunkKey, Version>> snapshots) {
  std::map<ChunkKey, Version> above;
  for (const auto& [chunk, version] : snapshots) {
    for (std::uint8_t level = 1; level <= kTileLevelMax; ++level) {
      Version& newest = above[tile_of(chunk.at, level)];
      newest = std::max(newest, version);
    }
  }
  for (const auto& [tile, version] : above) {
    Version& newest = newest_below_[tile];
    newest = std::max(newest, version);
    bind_key(s_.remove_older, tile);
    s_.remove_older.bind(5, std::int64_t{version.epoch})
        .bind(6, static_cast<std::int64_t>(version.seq));
    if (auto removed = s_.remove_older.run(); !removed) return failed(removed.error());
  }
  return {};
}

StoreResult<void> TileTable::clear() { return store_result(s_.clear.run()); }

}  // namespace runstone
