// sql::Error: the failure of a database call, and sql::Result.
#pragma once
#include <string>

#include "common/core/result.hpp"

namespace runstone::sql {

struct Error {
  enum class Kind {
    io,            // the disk, the file system or the connection failed, or any other failure
    full,          // the disk is full
    read_only,     // the database takes no writes, perhaps for a while
    corrupt,       // the file is damaged, or is no database
    locked,        // another connection holds a lock
    constraint,    // a row breaks a constraint of its table
    bad_statement  // the statement does not fit the database, e.g. a table is missing
  };
  Kind kind = Kind::io;
  std::string file;  // the name of the database, see Database::file()
  std::string what;  // the database's message
};

template <class T>
using Result = runstone::Result<T, Error>;

}  // namespace runstone::sql
