// A world's log to an .rlog file and back (docs/edit-log.md gives the bytes). Blocks on the disk: for programs.
#pragma once
#include <cstdint>
#include <string>

#include "common/core/result.hpp"
#include "common/rlog/rlog_writer.hpp"
#include "server/store/store.hpp"

namespace runstone {

struct RlogExport {
  std::uint64_t edits = 0;
  Sequence first = 1;       // of the log; behind the last one if there are no edits
  Sequence last = 0;        // exported
  std::uint64_t bytes = 0;  // of the file
};

/// Writes the log up to min(at, last) beside `file` and moves it there when it is complete and on disk; replaces
/// what stood there. The store may be open for reading only, with a server writing meanwhile. The error is one line.
Result<RlogExport, std::string> export_rlog(WorldReader& store, const std::string& file,
                                            Sequence at, RlogOptions options = {});

struct RlogImport {
  bool made_world = false;  // the folder held none
  std::uint64_t added = 0;  // edits
  std::uint64_t known = 0;  // in the log already, and equal
  std::uint64_t compacted =
      0;              // before the beginning of the world's log: in its base, not compared
  Sequence last = 0;  // of the world's log now
  std::string
      stopped;  // one line; empty if the file was sound to its end. What stands before is imported
};

/// Appends the edits of `file` to the world in `folder`, which must be the same world and end no earlier than the
/// file begins; what both have must be equal. Makes the world if the folder holds none and the file begins at the
/// beginning: same id, base from its generator, a server key of its own. Edits keep epoch and sequence. An import
/// that was broken off may be done again. The error is one line; the world then holds what was imported before it.
Result<RlogImport, std::string> import_rlog(const std::string& folder, const std::string& file);

}  // namespace runstone
