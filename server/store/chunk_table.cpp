#include "server/store/chunk_table.hpp"

#include <array>

#include "common/core/key_text.hpp"
#include "protocol/codec/chunk_codec.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {

namespace {

std::int64_t checksum_of(const std::string& table, const ChunkKey& key, const Version& version,
                         const Digest& digest, ByteView data) {
  return RowChecksum(table)
      .integer(key.lod)
      .integer(key.at.x)
      .integer(key.at.y)
      .integer(key.at.z)
      .integer(version.epoch)
      .integer(static_cast<std::int64_t>(version.seq))
      .integer(static_cast<std::int64_t>(digest.lane[0]))
      .integer(static_cast<std::int64_t>(digest.lane[1]))
      .blob(data)
      .value();
}

/// Takes the columns as they are stored, before they are cut to a key's types, so that no damage can hide in
/// a cut.
std::uint64_t fold_term(const std::array<std::int64_t, 6>& columns) {
  RowChecksum sum("fold");
  for (const std::int64_t column : columns) sum.integer(column);
  return static_cast<std::uint64_t>(sum.value());
}

std::uint64_t fold_term(const ChunkKey& key, const Version& version) {
  return fold_term(
      {key.lod, key.at.x, key.at.y, key.at.z, version.epoch, static_cast<std::int64_t>(version.seq)});
}

void bind_key(sql::Statement& statement, const ChunkKey& key) {
  statement.bind(1, std::int64_t{key.lod})
      .bind(2, std::int64_t{key.at.x})
      .bind(3, std::int64_t{key.at.y})
      .bind(4, std::int64_t{key.at.z});
}

/// Epoch and sequence as the columns hold them; damaged ones are cut here and caught by checksum or fold.
Version version_of(const sql::Statement& row, int column) {
  return {static_cast<Epoch>(row.integer(column)), static_cast<Sequence>(row.integer(column + 1))};
}

}  // namespace

StoreResult<ChunkTable> ChunkTable::open(sql::Database& database, Kind kind) {
  const std::string table = kind == Kind::snapshot ? "snapshot" : "base";
  const std::string where = " FROM " + table + " WHERE lod = ?1 AND x = ?2 AND y = ?3 AND z = ?4";
  auto load = database.prepare("SELECT epoch, seq, digest0, digest1, checksum, data" + where);
  if (!load) return Unexpected<StoreError>{load.error()};
  auto keys = database.prepare("SELECT lod, x, y, z, epoch, seq FROM " + table + " ORDER BY lod, x, y, z");
  if (!keys) return Unexpected<StoreError>{keys.error()};
  auto version = database.prepare("SELECT epoch, seq" + where);
  if (!version) return Unexpected<StoreError>{version.error()};
  auto save = database.prepare(
      "INSERT INTO " + table +
      "(lod, x, y, z, epoch, seq, digest0, digest1, checksum, data) "
      "VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10) ON CONFLICT(lod, x, y, z) DO UPDATE SET "
      "epoch = excluded.epoch, seq = excluded.seq, digest0 = excluded.digest0, digest1 = excluded.digest1, "
      "checksum = excluded.checksum, data = excluded.data");
  if (!save) return Unexpected<StoreError>{save.error()};
  return ChunkTable(database.file(), kind, table, *std::move(load), *std::move(keys), *std::move(version),
                    *std::move(save));
}

Unexpected<StoreError> ChunkTable::failure(StoreError::Kind kind, const ChunkKey& key,
                                           std::string what) const {
  return {{kind, file_, table_ + " chunk=" + text_of(key), std::move(what)}};
}

StoreResult<std::optional<Chunk>> ChunkTable::load(const ChunkKey& key, std::uint16_t chunk_edge) {
  const sql::ResetAtEnd reset_at_end(load_);
  bind_key(load_, key);
  const auto found = load_.step();
  if (!found) return Unexpected<StoreError>{found.error()};
  if (!*found) return std::optional<Chunk>();
  const Version version = version_of(load_, 0);
  const Digest digest{
      {static_cast<std::uint64_t>(load_.integer(2)), static_cast<std::uint64_t>(load_.integer(3))}};
  const ByteView data = load_.blob(5);
  if (load_.integer(4) != checksum_of(table_, key, version, digest, data)) {
    return failure(StoreError::Kind::corrupt, key, "checksum is wrong");
  }
  auto voxels = decode_chunk(data);
  if (!voxels) {
    return failure(StoreError::Kind::corrupt, key, std::string("does not decode: ") + voxels.error().what);
  }
  if (voxels->extent != Extent::cube(chunk_edge)) {
    return failure(StoreError::Kind::corrupt, key, "has the wrong size");
  }
  if (digest_of(*voxels) != digest) {
    return failure(StoreError::Kind::corrupt, key, "has voxels that do not match its digest");
  }
  return std::optional<Chunk>({*std::move(voxels), version, digest});
}

StoreResult<std::vector<std::pair<ChunkKey, Version>>> ChunkTable::keys(const RowFold& expected) {
  const sql::ResetAtEnd reset_at_end(keys_);
  std::vector<std::pair<ChunkKey, Version>> keys;
  RowFold fold;
  for (;;) {
    const auto more = keys_.step();
    if (!more) return Unexpected<StoreError>{more.error()};
    if (!*more) break;
    const ChunkKey key{
        static_cast<std::uint8_t>(keys_.integer(0)),
        {static_cast<std::int32_t>(keys_.integer(1)), static_cast<std::int32_t>(keys_.integer(2)),
         static_cast<std::int32_t>(keys_.integer(3))}};
    ++fold.count;
    fold.sum += fold_term({keys_.integer(0), keys_.integer(1), keys_.integer(2), keys_.integer(3),
                           keys_.integer(4), keys_.integer(5)});
    keys.emplace_back(key, version_of(keys_, 4));
  }
  if (fold != expected) {
    return Unexpected<StoreError>{
        {StoreError::Kind::corrupt, file_, table_,
         "rows vanished, appeared or changed their key or version: " + std::to_string(fold.count) +
             " rows, meta counts " + std::to_string(expected.count)}};
  }
  return keys;
}

StoreResult<void> ChunkTable::save(const ChunkKey& key, const Chunk& chunk, std::uint16_t chunk_edge,
                                   RowFold& fold) {
  if (chunk.voxels.extent != Extent::cube(chunk_edge)) {
    return failure(StoreError::Kind::bad_request, key, "is not a cube of the world's chunk edge");
  }
  if (digest_of(chunk.voxels) != chunk.digest) {
    return failure(StoreError::Kind::bad_request, key, "carries a digest that is not that of its voxels");
  }
  std::optional<Version> stored;
  {
    const sql::ResetAtEnd reset_at_end(version_);
    bind_key(version_, key);
    const auto found = version_.step();
    if (!found) return Unexpected<StoreError>{found.error()};
    if (*found) stored = version_of(version_, 0);
  }
  if (stored && kind_ == Kind::base && chunk.version == *stored) {
    return failure(StoreError::Kind::bad_request, key, "is there already");  // an import named it twice
  }
  if (stored && chunk.version < *stored) {
    return failure(StoreError::Kind::bad_request, key, "is older than the stored version");
  }
  const Bytes data = encode_chunk(chunk.voxels, ChunkEncoding::packed);
  bind_key(save_, key);
  save_.bind(5, std::int64_t{chunk.version.epoch})
      .bind(6, static_cast<std::int64_t>(chunk.version.seq))
      .bind(7, static_cast<std::int64_t>(chunk.digest.lane[0]))
      .bind(8, static_cast<std::int64_t>(chunk.digest.lane[1]))
      .bind(9, checksum_of(table_, key, chunk.version, chunk.digest, data))
      .bind(10, ByteView(data));
  if (auto saved = save_.run(); !saved) return saved;
  if (stored) fold.sum -= fold_term(key, *stored);
  fold.count += stored ? 0 : 1;
  fold.sum += fold_term(key, chunk.version);
  return {};
}

}  // namespace runstone
