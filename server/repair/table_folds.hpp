// table_folds: the folds of the tables of a world, as `meta` has them and as their rows give them.
#pragma once
#include <array>
#include <optional>
#include <string>

#include "common/sql/database.hpp"
#include "server/repair/found_row.hpp"
#include "server/store/meta_table.hpp"

namespace runstone {

/// The tables that have a fold in `meta`, but for those of the library.
inline constexpr std::array kFoldedTables = {
    FoundTable::base,       FoundTable::rights_record,   FoundTable::player,
    FoundTable::name_claim, FoundTable::player_instance, FoundTable::snapshot};

/// Returns the key in `meta` of the fold of a table.
std::string fold_key_of(FoundTable table);
/// Returns the fold in a row of `meta`, or nullopt if there is none.
std::optional<RowFold> fold_in(const MetaRows& rows, const std::string& key);
/// Returns the fold of the rows of a table. Requires one of kFoldedTables. Fails (corrupt) if a row
/// is damaged. Cost: O(rows).
StoreResult<RowFold> fold_of(sql::Database& database, FoundTable table);

}  // namespace runstone
