// The first rows of a world.
#pragma once
#include <string>

#include "common/sql/database.hpp"
#include "server/store/store_error.hpp"
#include "server/store/world_info.hpp"

namespace runstone {

/// Fails (bad_request) if a world with this meta could not be read again. `file` names the world in
/// the error.
StoreResult<void> check_new_meta(const WorldMeta& meta, const std::string& file);
/// Makes all tables of a world in an empty database, and writes the rows of a world without edits,
/// in the caller's transaction.
StoreResult<void> fill_new_world(sql::Database& database, const WorldMeta& meta);

}  // namespace runstone
