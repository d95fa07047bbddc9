// The rule that keeps a mistyped address of a database from becoming a folder of that name. A place
// is a folder or the address of a PostgreSQL database, see create_world(). Thread: any.
#pragma once
#include <string>

#include "common/core/result.hpp"

namespace runstone {

/// Fails if the text looks like the address of a database and is not that of a PostgreSQL database,
/// such as postgre://... or "host=localhost dbname=valley". The error is what is wrong with the
/// text, and has no password. A folder of such a name is reached as ./NAME.
Result<void, std::string> check_place(const std::string& place);
/// Fails like check_place(), and if the text is the address of a database.
Result<void, std::string> check_folder(const std::string& folder);
/// Fails if the text is not the address of a PostgreSQL database.
Result<void, std::string> check_database_address(const std::string& address);

/// Returns the error of check_place() or an empty text, as the parser of a command line takes it.
std::string place_refusal(const std::string& place);
/// Returns the error of check_folder() or an empty text, as the parser of a command line takes it.
std::string folder_refusal(const std::string& folder);

}  // namespace runstone
