#include "server/repair/table_folds.hpp"

#include "server/store/chunk_table.hpp"
#include "server/store/claim_table.hpp"
#include "server/store/kept_records.hpp"
#include "server/store/player_table.hpp"
#include "server/store/sql_result.hpp"

namespace runstone {
namespace {

template <class Table, class Rows>
StoreResult<RowFold> fold_of_rows(sql::Database& database, Rows rows) {
  auto table = Table::open(database);
  if (!table) return failed(table.error());
  const auto found = rows(*table);
  if (!found) return failed(found.error());
  return found->fold;
}

StoreResult<RowFold> fold_of_chunks(sql::Database& database, ChunkTable::Kind kind) {
  auto table = ChunkTable::open(database, kind);
  if (!table) return failed(table.error());
  return table->fold();
}

}  // namespace

std::string fold_key_of(FoundTable table) { return std::string(columns_of(table).name) + "_fold"; }

std::optional<RowFold> fold_in(const MetaRows& rows, const std::string& key) {
  const auto row = rows.find(key);
  const auto* bytes = row == rows.end() ? nullptr : std::get_if<Bytes>(&row->second);
  if (bytes == nullptr || bytes->size() != 16) return std::nullopt;
  ByteReader reader(*bytes);
  const std::uint64_t count = reader.u64();
  return RowFold{count, reader.u64()};
}

StoreResult<RowFold> fold_of(sql::Database& database, FoundTable table) {
  switch (table) {
    case FoundTable::base:
      return fold_of_chunks(database, ChunkTable::Kind::base);
    case FoundTable::rights_record:
      return fold_of_rows<KeptRecords>(database, [](KeptRecords& rows) { return rows.records(); });
    case FoundTable::player:
      return fold_of_rows<PlayerTable>(database, [](PlayerTable& rows) { return rows.players(); });
    case FoundTable::name_claim:
      return fold_of_rows<ClaimTable>(database, [](ClaimTable& rows) { return rows.claims(); });
    case FoundTable::player_instance:
      return fold_of_rows<PlayerTable>(database,
                                       [](PlayerTable& rows) { return rows.high_waters(); });
    default:
      return fold_of_chunks(database, ChunkTable::Kind::snapshot);
  }
}

}  // namespace runstone
