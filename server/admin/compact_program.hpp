// runstone-server compact: takes the oldest part of a world's log into its base, while no server runs it.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>

#include "common/core/result.hpp"
#include "server/store/sqlite_store.hpp"

namespace runstone {

struct CompactRequest {
  std::string world;            // folder
  std::uint64_t keep_days = 0;  // edits that are younger stay
  bool shrink = true;           // give the free space back to the file system
  bool progress = false;        // also where stderr is no terminal
};

/// `now_us`: UTC. Prints what it did, or that there is nothing to do. The error is one line; the world then stands as before, or, if
/// only the space could not be given back, compacted, which is said.
Result<void, std::string> compact_world(const CompactRequest& request, TimeUs now_us,
                                        std::ostream& out, const SqliteOptions& options = {});

}  // namespace runstone
