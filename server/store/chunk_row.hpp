// ChunkRow: the columns that every table of chunks has, and what makes such a row sound. Internal to store.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/runs/chunk.hpp"
#include "common/sqlite/database.hpp"

namespace runstone {

/// A row as it is stored, not yet trusted.
struct ChunkRow {
  ChunkKey key;
  Version version;
  Digest digest;
  std::int64_t checksum = 0;
  ByteView data;  // packed
};

/// Checksum that belongs to the row; `table` is part of it.
std::int64_t checksum_of(std::string_view table, const ChunkRow& row);

/// The chunk, if checksum, encoding, size and digest are right; else what is wrong.
Result<Chunk, std::string> chunk_of(std::string_view table, const ChunkRow& row,
                                    std::uint16_t chunk_edge);

/// What keeps a chunk from being stored under its digest in a world of this edge; empty if nothing does.
std::string unfit(const Chunk& chunk, std::uint16_t chunk_edge);

/// Binds lod, x, y, z to parameters 1 to 4.
void bind_key(sql::Statement& statement, const ChunkKey& key);
/// Columns from `column` on; damaged numbers are cut here and caught by checksum, fold or digest.
ChunkKey key_at(const sql::Statement& row, int column);     // lod, x, y, z
Version version_at(const sql::Statement& row, int column);  // epoch, seq
Digest digest_at(const sql::Statement& row, int column);    // digest0, digest1

}  // namespace runstone
