// sql::Error: the failure of a database call, and sql::Result.
#pragma once
#include <string>

#include "common/core/result.hpp"

struct sqlite3;

namespace runstone::sql {

struct Error {
  enum class Kind {
    io,            // the disk or the file system failed, or any other failure
    full,          // the disk is full
    corrupt,       // the file is damaged, or is no database
    locked,        // another connection holds a lock
    constraint,    // a row breaks a constraint of its table
    bad_statement  // the statement does not fit the database, e.g. a table is missing
  };
  Kind kind = Kind::io;
  std::string file;  // the main file of the database
  std::string what;  // SQLite's message, with the system's error number if there is one
};

template <class T>
using Result = runstone::Result<T, Error>;

/// Returns the error of the last call on a connection. `code` is the result of that call. A null
/// handle means that there was no memory for a connection.
Unexpected<Error> failure(sqlite3* handle, int code);

}  // namespace runstone::sql
