// runstone-replay import: appends an .rlog file to a world's log, or makes the world
// (docs/replay.md).
#pragma once
#include <iosfwd>
#include <string>

#include "common/core/result.hpp"
#include "server/replay/subcommand_options.hpp"

namespace runstone {

struct ImportOptions {
  CommonOptions common;
  std::string file;
};

void declare_import(SubcommandOptions& command_line, ImportOptions& options);
/// Imports the file up to its first damaged block and prints a table. Fails if anything of the file
/// is damaged; the edits before it stay imported.
Result<int, std::string> run_import(const ImportOptions& options, std::ostream& out);

}  // namespace runstone
