// runstone-server compact: moves the oldest part of a world's log into its base, while no server
// runs it.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>

#include "common/core/result.hpp"
#include "server/store/sqlite_backend.hpp"

namespace runstone {

struct CompactRequest {
  std::string world;            // folder
  std::uint64_t keep_days = 0;  // younger edits stay in the log
  bool shrink = true;           // give the free space back to the file system
  bool progress = false;        // print progress even if standard error is no terminal
  bool is_confirmed = false;    // with keep_days 0: no edit needs to stay
};

/// Compacts the world and prints the result, or prints that no edit is old enough. `now_us` is the
/// time in UTC. The error is one line. After an error the world is as before, or, if only the space
/// could not be given back, compacted; the error then says so. Fails if keep_days is 0 and the log
/// would lose edits, unless the request is confirmed.
Result<void, std::string> compact_world(const CompactRequest& request, TimeUs now_us,
                                        std::ostream& out, const SqliteOptions& options = {});

}  // namespace runstone
