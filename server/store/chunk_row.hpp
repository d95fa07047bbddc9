// ChunkRow: the columns that every table of chunks has, and the checks of such a row. Internal to
// the store.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/runs/chunk.hpp"
#include "common/sql/database.hpp"
#include "server/store/chunk_reader.hpp"

namespace runstone {

/// A row as it is stored, before any check.
struct ChunkRow {
  ChunkKey key;
  Version version;
  Digest digest;
  std::int64_t checksum = 0;
  ByteView data;  // packed
};

/// Returns the checksum that the row must have. `table`, the name of its table, is part of it.
std::int64_t checksum_of(std::string_view table, const ChunkRow& row);

/// Returns the chunk of a row. Fails with the cause if checksum, encoding or size are wrong, or the
/// digest, if it is checked.
Result<Chunk, std::string> chunk_of(std::string_view table, const ChunkRow& row,
                                    std::uint16_t chunk_edge, RowCheck check);

/// Returns the reason why a chunk cannot be stored in a world of this edge, or an empty string if
/// it can.
std::string unfit(const Chunk& chunk, std::uint16_t chunk_edge);

/// Returns the statement that inserts or replaces a row. Its parameters are lod, x, y, z, epoch,
/// seq, both halves of the digest, checksum and data.
std::string save_chunk_text(const std::string& table);
/// Binds lod, x, y, z to parameters 1 to 4.
void bind_key(sql::Statement& statement, const ChunkKey& key);
/// Return values of the columns from `column` on. A damaged number may be cut to its type here.
/// Checksum, fold or digest then detect the damage.
ChunkKey key_at(const sql::Statement& row, int column);     // lod, x, y, z
Version version_at(const sql::Statement& row, int column);  // epoch, seq
Digest digest_at(const sql::Statement& row, int column);    // digest0, digest1

}  // namespace runstone
