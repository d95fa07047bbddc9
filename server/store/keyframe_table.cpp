#include "server/store/keyframe_table.hpp"

#include <algorithm>
#include <map>

#include "common/core/key_text.hpp"
#include "protocol/chunks/chunk_codec.hpp"
#include "server/store/chunk_row.hpp"
#include "server/store/index_hint.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {

namespace {

constexpr std::string_view kChunks = "keyframe_chunk";

std::int64_t checksum_of(const Keyframe& keyframe) {
  return RowChecksum("keyframe")
      .integer(static_cast<std::int64_t>(keyframe.at.version.seq))
      .integer(keyframe.at.version.epoch)
      .integer(keyframe.at.time_us)
      .integer(static_cast<std::int64_t>(keyframe.chunks))
      .integer(static_cast<std::int64_t>(keyframe.world_digest.lane[0]))
      .integer(static_cast<std::int64_t>(keyframe.world_digest.lane[1]))
      .value();
}

std::string place_of(const ChunkKey& key, Sequence seq) {
  return std::string(kChunks) + " chunk=" + text_of(key) + " seq=" + std::to_string(seq);
}

std::string place_of(const Keyframe& keyframe) {
  return "keyframe seq=" + std::to_string(keyframe.at.version.seq);
}

}  // namespace

StoreResult<KeyframeTable> KeyframeTable::open(sql::Database& database) {
  StoreResult<void> prepared;
  const auto prepare = [&](std::string_view text) {
    auto statement = database.prepare(text);
    if (!statement && prepared) prepared = failed(statement.error());
    return statement ? *std::move(statement) : sql::Statement();
  };
  Statements statements{
      prepare("SELECT seq, epoch, time_us, chunks, digest0, digest1, checksum FROM keyframe "
              "ORDER BY seq"),
      prepare("SELECT lod, x, y, z, epoch, seq, digest0, digest1 FROM keyframe_chunk" +
              indexed_by(database, "keyframe_chunk_digest") +
              " WHERE seq <= ?1 ORDER BY seq, lod, x, y, z"),
      prepare("SELECT epoch, seq, digest0, digest1, checksum, data FROM keyframe_chunk "
              "WHERE lod = ?1 AND x = ?2 AND y = ?3 AND z = ?4 AND seq = ?5"),
      prepare("SELECT epoch, seq, digest0, digest1, checksum, data FROM keyframe_chunk "
              "WHERE lod = ?1 AND x = ?2 AND y = ?3 AND z = ?4 AND seq <= ?5 "
              "ORDER BY seq DESC LIMIT 1"),
      prepare(
          "INSERT INTO keyframe_chunk(lod, x, y, z, seq, epoch, digest0, digest1, checksum, data) "
          "VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10)"),
      prepare("INSERT INTO keyframe(seq, epoch, time_us, chunks, digest0, digest1, checksum) "
              "VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7)"),
      prepare("SELECT count(*) FROM keyframe WHERE seq <= ?1"),
      prepare("DELETE FROM keyframe_chunk WHERE seq <= ?1"),
      prepare("DELETE FROM keyframe WHERE seq <= ?1")};
  if (!prepared) return failed(prepared.error());
  return KeyframeTable(database.file(), std::move(statements));
}

Unexpected<StoreError> KeyframeTable::corrupt(std::string where, std::string what) const {
  return {{StoreError::Kind::corrupt, file_, std::move(where), std::move(what)}};
}

StoreResult<std::vector<Keyframe>> KeyframeTable::all() {
  const sql::ResetAtEnd reset_at_end(s_.all);
  std::vector<Keyframe> keyframes;
  for (;;) {
    const auto more = s_.all.step();
    if (!more) return failed(more.error());
    if (!*more) return keyframes;
    const Keyframe keyframe{
        {{static_cast<Epoch>(s_.all.integer(1)), static_cast<Sequence>(s_.all.integer(0))},
         s_.all.integer(2)},
        static_cast<std::uint64_t>(s_.all.integer(3)),
        digest_at(s_.all, 4)};
    if (s_.all.integer(6) != checksum_of(keyframe))
      return corrupt(place_of(keyframe), "checksum is wrong");
    keyframes.push_back(keyframe);
  }
}

StoreResult<std::vector<StoredChunk>> KeyframeTable::rows(Sequence last) {
  const sql::ResetAtEnd reset_at_end(s_.rows);
  s_.rows.bind(1, static_cast<std::int64_t>(last));
  std::vector<StoredChunk> rows;
  for (;;) {
    const auto more = s_.rows.step();
    if (!more) return failed(more.error());
    if (!*more) return rows;
    rows.push_back({key_at(s_.rows, 0), version_at(s_.rows, 4), digest_at(s_.rows, 6), false});
  }
}

StoreResult<std::optional<Chunk>> KeyframeTable::load(const ChunkKey& key, Sequence seq,
                                                      std::uint16_t chunk_edge, RowCheck check) {
  return read(s_.load, key, seq, chunk_edge, check);
}

StoreResult<std::optional<Chunk>> KeyframeTable::newest(const ChunkKey& key, Sequence last,
                                                        std::uint16_t chunk_edge, RowCheck check) {
  return read(s_.newest, key, last, chunk_edge, check);
}

StoreResult<std::optional<Chunk>> KeyframeTable::read(sql::Statement& row, const ChunkKey& key,
                                                      Sequence seq, std::uint16_t chunk_edge,
                                                      RowCheck check) {
  const sql::ResetAtEnd reset_at_end(row);
  bind_key(row, key);
  const auto found = row.bind(5, static_cast<std::int64_t>(seq)).step();
  if (!found) return failed(found.error());
  if (!*found) return std::optional<Chunk>();
  const Version version = version_at(row, 0);
  auto chunk = chunk_of(kChunks, {key, version, digest_at(row, 2), row.integer(4), row.blob(5)},
                        chunk_edge, check);
  if (!chunk) return corrupt(place_of(key, version.seq), chunk.error());
  return std::optional<Chunk>(*std::move(chunk));
}

StoreResult<void> KeyframeTable::save(const ChunkKey& key, const Chunk& chunk,
                                      std::uint16_t chunk_edge) {
  const Sequence seq = chunk.version.seq;
  if (const std::string what = unfit(chunk, chunk_edge); !what.empty()) {
    return failure(StoreError{StoreError::Kind::bad_request, file_, place_of(key, seq), what});
  }
  const auto stored = load(key, seq, chunk_edge, RowCheck::voxels);
  if (!stored) return failed(stored.error());
  if (stored->has_value()) {
    if ((*stored)->version == chunk.version && (*stored)->digest == chunk.digest) return {};
    return corrupt(place_of(key, seq), "holds other voxels than base and log make");
  }
  const Bytes data = encode_chunk(chunk.voxels, ChunkEncoding::packed);
  bind_key(s_.save_chunk, key);
  return store_result(
      s_.save_chunk.bind(5, static_cast<std::int64_t>(seq))
          .bind(6, std::int64_t{chunk.version.epoch})
          .bind(7, static_cast<std::int64_t>(chunk.digest.lane[0]))
          .bind(8, static_cast<std::int64_t>(chunk.digest.lane[1]))
          .bind(9, runstone::checksum_of(kChunks, {key, chunk.version, chunk.digest, 0, data}))
          .bind(10, ByteView(data))
          .run());
}

StoreResult<void> KeyframeTable::save(const Keyframe& keyframe) {
  return store_result(s_.save.bind(1, static_cast<std::int64_t>(keyframe.at.version.seq))
                          .bind(2, std::int64_t{keyframe.at.version.epoch})
                          .bind(3, keyframe.at.time_us)
                          .bind(4, static_cast<std::int64_t>(keyframe.chunks))
                          .bind(5, static_cast<std::int64_t>(keyframe.world_digest.lane[0]))
                          .bind(6, static_cast<std::int64_t>(keyframe.world_digest.lane[1]))
                          .bind(7, checksum_of(keyframe))
                          .run());
}

StoreResult<std::uint64_t> KeyframeTable::remove(Sequence last) {
  std::uint64_t count = 0;
  {
    const sql::ResetAtEnd reset_at_end(s_.count);
    const auto counted = s_.count.bind(1, static_cast<std::int64_t>(last)).step();
    if (!counted) return failed(counted.error());
    count = static_cast<std::uint64_t>(s_.count.integer(0));
  }
  for (sql::Statement* statement : {&s_.remove_chunks, &s_.remove}) {
    if (auto removed = statement->bind(1, static_cast<std::int64_t>(last)).run(); !removed)
      return failed(removed.error());
  }
  return count;
}

StoreResult<void> KeyframeTable::prove(const std::vector<Keyframe>& keyframes,
                                       const std::vector<StoredChunk>& start,
                                       const std::vector<StoredChunk>& rows) const {
  std::map<ChunkKey, Digest> newest;
  Digest sum;
  const auto take = [&](const StoredChunk& chunk) {
    Digest& digest = newest[chunk.key];
    sum = sum - world_digest_term(chunk.key, digest) + world_digest_term(chunk.key, chunk.digest);
    digest = chunk.digest;
  };
  for (const StoredChunk& chunk : start) take(chunk);
  auto row = rows.begin();
  for (const Keyframe& keyframe : keyframes) {
    for (; row != rows.end() && row->version.seq <= keyframe.at.version.seq; ++row) take(*row);
    if (newest.size() != keyframe.chunks || sum != keyframe.world_digest) {
      return corrupt(place_of(keyframe),
                     "does not agree with its chunks: rows vanished, appeared or changed (" +
                         std::to_string(newest.size()) + " chunks, the keyframe counts " +
                         std::to_string(keyframe.chunks) + ")");
    }
  }
  return {};
}

std::vector<StoredChunk> newest_of(std::vector<StoredChunk> start,
                                   const std::vector<StoredChunk>& rows) {
  start.insert(start.end(), rows.begin(), rows.end());
  // The newest of equal keys comes first, and std::unique keeps the first.
  std::sort(start.begin(), start.end(), [](const StoredChunk& a, const StoredChunk& b) {
    if (a.key != b.key) return a.key < b.key;
    return a.version != b.version ? b.version < a.version : a.is_base < b.is_base;
  });
  start.erase(
      std::unique(start.begin(), start.end(),
                  [](const StoredChunk& a, const StoredChunk& b) { return a.key == b.key; }),
      start.end());
  return start;
}

}  // namespace runstone
