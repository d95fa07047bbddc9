// compact_by_hand: writes the result of a compaction to the disk: a newer base, a log that begins
// after it, and the head of the removed part.
#pragma once
#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "common/sql/transaction.hpp"
#include "server/store/chunk_table.hpp"
#include "server/store/meta_table.hpp"
#include "tests/support/sql/temp_place.hpp"

namespace runstone::test {

/// Removes edits 1 .. head.version.seq from the log of a closed world and makes `chunks` base
/// chunks.
inline void compact_by_hand(const std::string& file, const LogEnd& head,
                            const std::vector<std::pair<ChunkKey, ChunkPtr>>& chunks) {
  auto database = open_database(file);
  REQUIRE(database.has_value());
  auto meta = MetaTable::open(*database);
  auto base = ChunkTable::open(*database, ChunkTable::Kind::base);
  REQUIRE((meta.has_value() && base.has_value()));
  auto transaction = sql::Transaction::begin(*database);
  REQUIRE(transaction.has_value());
  auto fold = meta->fold(base->fold_key());
  REQUIRE(fold.has_value());
  for (const auto& [key, chunk] : chunks) {
    REQUIRE(base->save(key, *chunk, chunk->voxels.extent.x, *fold).has_value());
  }
  REQUIRE(meta->put_fold(base->fold_key(), *fold).has_value());
  REQUIRE(meta->put_log_head(head).has_value());
  const std::string cut = "DELETE FROM edit_log WHERE seq <= " + std::to_string(head.version.seq);
  REQUIRE(database->run(cut.c_str()).has_value());
  REQUIRE(transaction->commit().has_value());
}

}  // namespace runstone::test
