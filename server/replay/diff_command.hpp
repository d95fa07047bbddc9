// runstone-replay diff: the voxels that differ between two moments, and whose edits changed them.
#pragma once
#include <iosfwd>
#include <optional>
#include <string>

#include "common/core/result.hpp"
#include "server/history/named_moment.hpp"
#include "server/replay/subcommand_options.hpp"

namespace runstone {

struct DiffOptions {
  CommonOptions common;
  std::optional<NamedMoment> from, to;  // both are set once the command line is parsed
};

void declare_diff(SubcommandOptions& command_line, DiffOptions& options);
/// Prints the table. Requires from and to.
Result<int, std::string> run_diff(const DiffOptions& options, std::ostream& out);

}  // namespace runstone
