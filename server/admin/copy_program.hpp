// runstone-server copy: copies a world from a folder to a PostgreSQL database, or back.
#pragma once
#include <iosfwd>
#include <string>

#include "common/core/result.hpp"

namespace runstone {

struct CopyRequest {
  std::string from, to;   // a folder, or postgresql://...
  bool progress = false;  // print progress even if standard error is no terminal
};

/// Copies and verifies a world (copy_stored_world()), and prints how many rows it has. The error is
/// one line.
Result<void, std::string> copy_between(const CopyRequest& request, std::ostream& out);

}  // namespace runstone
