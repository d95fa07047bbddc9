// runstone-replay copy: writes the world of a moment as a new world.
#pragma once
#include <iosfwd>
#include <optional>
#include <string>

#include "common/core/result.hpp"
#include "server/history/named_moment.hpp"
#include "server/replay/subcommand_options.hpp"

namespace runstone {

struct CopyOptions {
  CommonOptions common;
  std::string folder;             // of the new world
  std::optional<NamedMoment> at;  // default: the end of the log
};

void declare_copy(SubcommandOptions& command_line, CopyOptions& options);
/// Makes the new world and prints a table.
Result<int, std::string> run_copy(const CopyOptions& options, std::ostream& out);

}  // namespace runstone
