// runstone-replay export: writes a world's log to an .rlog file (docs/edit-log.md).
#pragma once
#include <iosfwd>
#include <optional>
#include <string>

#include "common/core/result.hpp"
#include "server/history/named_moment.hpp"
#include "server/replay/subcommand_options.hpp"

namespace runstone {

struct ExportOptions {
  CommonOptions common;
  std::string file;
  std::optional<NamedMoment> at;  // last edit of the file; default: the end of the log
};

void declare_export(SubcommandOptions& command_line, ExportOptions& options);
/// Writes the file and prints a table.
Result<int, std::string> run_export(const ExportOptions& options, std::ostream& out);

}  // namespace runstone
