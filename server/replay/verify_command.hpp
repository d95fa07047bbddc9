// runstone-replay verify: rebuilds a world from base and log and compares digests.
#pragma once
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "server/history/named_moment.hpp"
#include "server/replay/subcommand_options.hpp"

namespace runstone {

struct VerifyOptions {
  CommonOptions common;
  std::optional<NamedMoment> at;     // end of the replay; default: the end of the log
  std::vector<std::string> against;  // digest lists
  bool quick = false;                // read no row that the replay does not need
};

void declare_verify(SubcommandOptions& command_line, VerifyOptions& options);

/// Prints what was compared, and the first difference. Returns kReplayEqual, or kReplayDifferent if
/// there is a difference or the world lacks edits that were durable.
Result<int, std::string> run_verify(const VerifyOptions& options, std::ostream& out);

}  // namespace runstone
