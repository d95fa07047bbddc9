#include "server/store/chunk_row.hpp"

#include <utility>

#include "protocol/chunks/chunk_codec.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {

std::int64_t checksum_of(std::string_view table, const ChunkRow& row) {
  return RowChecksum(table)
      .integer(row.key.lod)
      .integer(row.key.at.x)
      .integer(row.key.at.y)
      .integer(row.key.at.z)
      .integer(row.version.epoch)
      .integer(static_cast<std::int64_t>(row.version.seq))
      .integer(static_cast<std::int64_t>(row.digest.lane[0]))
      .integer(static_cast<std::int64_t>(row.digest.lane[1]))
      .blob(row.data)
      .value();
}

Result<Chunk, std::string> chunk_of(std::string_view table, const ChunkRow& row,
                                    std::uint16_t chunk_edge, RowCheck check) {
  const auto wrong = [](std::string what) { return failure(std::move(what)); };
  if (row.checksum != checksum_of(table, row)) return wrong("checksum is wrong");
  auto voxels = decode_chunk(row.data);
  if (!voxels) return wrong(std::string("does not decode: ") + voxels.error().what);
  if (voxels->extent != Extent::cube(chunk_edge)) return wrong("has the wrong size");
  if (check == RowCheck::voxels && digest_of(*voxels) != row.digest)
    return wrong("has voxels that do not match its digest");
  return Chunk{*std::move(voxels), row.version, row.digest};
}

std::string unfit(const Chunk& chunk, std::uint16_t chunk_edge) {
  if (chunk.voxels.extent != Extent::cube(chunk_edge))
    return "is not a cube of the world's chunk edge";
  if (digest_of(chunk.voxels) != chunk.digest)
    return "carries a digest that is not that of its voxels";
  return "";
}

std::string save_chunk_text(const std::string& table) {
  return "INSERT INTO " + table +
         "(lod, x, y, z, epoch, seq, digest0, digest1, checksum, data) "
         "VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10) ON CONFLICT(lod, x, y, z) "
         "DO UPDATE SET epoch = excluded.epoch, seq = excluded.seq, digest0 = excluded.digest0, "
         "digest1 = excluded.digest1, checksum = excluded.checksum, data = excluded.data";
}

void bind_key(sql::Statement& statement, const ChunkKey& key) {
  statement.bind(1, std::int64_t{key.lod})
      .bind(2, std::int64_t{key.at.x})
      .bind(3, std::int64_t{key.at.y})
      .bind(4, std::int64_t{key.at.z});
}

ChunkKey key_at(const sql::Statement& row, int column) {
  return {static_cast<std::uint8_t>(row.integer(column)),
          {static_cast<std::int32_t>(row.integer(column + 1)),
           static_cast<std::int32_t>(row.integer(column + 2)),
           static_cast<std::int32_t>(row.integer(column + 3))}};
}

Version version_at(const sql::Statement& row, int column) {
  return {static_cast<Epoch>(row.integer(column)), static_cast<Sequence>(row.integer(column + 1))};
}

Digest digest_at(const sql::Statement& row, int column) {
  return {{static_cast<std::uint64_t>(row.integer(column)),
           static_cast<std::uint64_t>(row.integer(column + 1))}};
}

}  // namespace runstone
