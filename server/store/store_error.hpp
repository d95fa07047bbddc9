// StoreError: the failure of a call to a store, and StoreResult.
#pragma once
#include <string>

#include "common/core/result.hpp"

namespace runstone {

struct StoreError {
  enum class Kind {
    io,
    not_a_world,
    newer_version,
    corrupt,
    exists,
    full,       // the disk is full: a later try may succeed
    read_only,  // the database takes no writes: a later try may succeed
    bad_request,
    locked,
    cancelled
  };
  Kind kind = Kind::io;
  std::string file;  // the database
  // The table and row, such as "edit_log seq=9120" or "snapshot chunk=1,0,-3"; may be empty.
  std::string where;
  std::string what;
  /// Returns true if the same call may succeed later: the disk, the database or a lock failed it, and
  /// not what is stored.
  bool may_pass() const {
    return kind == Kind::io || kind == Kind::locked || kind == Kind::full ||
           kind == Kind::read_only;
  }
  /// Returns one line: "FILE: WHERE: WHAT".
  std::string message() const;
};

/// Returns true if nothing was written and a later try may succeed: the disk is full, or the
/// database takes no writes.
inline bool can_be_repeated(const StoreError& error) {
  return error.kind == StoreError::Kind::full || error.kind == StoreError::Kind::read_only;
}

template <class T>
using StoreResult = Result<T, StoreError>;

}  // namespace runstone
