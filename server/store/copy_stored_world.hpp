// copy_stored_world: copies a world from one place to another, e.g. from SQLite to PostgreSQL or
// back.
#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "common/core/ids.hpp"
#include "server/store/store_error.hpp"

namespace runstone {

struct CopiedWorld {
  std::uint64_t rows = 0;
  Sequence last = 0;  // of the copied log
};

using CopyProgress = std::function<void(std::uint64_t rows, std::uint64_t all)>;

/// Copies every row of a world, as it is at one moment, and verifies the copy
/// (WorldReader::check()). `from` and `to` are places, see create_world(). The copy is the same
/// world: its id, its keys and its log are those of the original, so only one of the two may go on.
/// Fails
///   - as open_world() of `from`;
///   - as create_world() of `to`. A copy that is interrupted leaves nothing in a database. In a
///     folder it may leave a file;
///   - as WorldReader::check() if the original is damaged. The copy then stays, with the same
///     damage.
/// `progress` is called with the rows so far and the number of all. Blocks.
StoreResult<CopiedWorld> copy_stored_world(const std::string& from, const std::string& to,
                                           const CopyProgress& progress = {});

}  // namespace runstone
