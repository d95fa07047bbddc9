// Export of a world's log to an .rlog file, and import from one (docs/edit-log.md has the bytes).
// Calls block on the disk.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>

#include "common/core/result.hpp"
#include "common/rlog/rlog_writer.hpp"
#include "server/store/store.hpp"

namespace runstone {

struct RlogExport {
  std::uint64_t edits = 0;
  Sequence first = 1;       // exported; last + 1 if there are no edits
  Sequence last = 0;        // exported
  std::uint64_t bytes = 0;  // of the file
};

/// Writes the log up to min(at, last). The file gets its name when it is complete and on disk, and
/// replaces an old one. The store may be open for reading only while a server writes it. The error
/// is one line.
Result<RlogExport, std::string> export_rlog(WorldReader& store, const std::string& file,
                                            Sequence at, RlogOptions options = {});

struct RlogImport {
  bool made_world = false;  // the place held no world
  std::uint64_t added = 0;  // edits
  std::uint64_t known = 0;  // edits that the log had already, and equal
  /// Edits before the beginning of the world's log: they are part of its base and are not compared.
  std::uint64_t compacted = 0;
  Sequence last = 0;  // of the world's log after the import
  /// One line about the damage that ended the import; empty if the file is sound. Edits before it
  /// are imported.
  std::string stopped;
};

struct RlogImportRequest {
  std::string place;          // a folder or a database
  std::string file;           // the .rlog file
  bool until_damage = false;  // make a new world of a damaged file, up to the damage
};

/// Appends the edits of the file to the world at the place. It must be the same world and must end
/// no earlier than the file begins; edits that both have must be equal. Edits keep epoch and
/// sequence number. An interrupted import can be repeated. What was imported into a world before an
/// error stays.
/// If the place holds no world and the file begins at edit 1, the world is made: same id, base of its
/// generator, a new server key. A folder gets its world only when the import is complete (NewFolder).
/// After an error it has no world. If the file is damaged, it gets a world with `until_damage` only.
/// In a database, the edits that were imported before an error or the damage stay. Prints a line about
/// an interrupted import that it removes to `out`. The error is one line.
Result<RlogImport, std::string> import_rlog(const RlogImportRequest& request, std::ostream& out);

}  // namespace runstone
