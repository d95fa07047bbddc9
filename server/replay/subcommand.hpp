// Subcommand: one thing that runstone-replay can do. Each one has a file of its own with its
// options, a function that declares them on the command line, and a function that runs it.
#pragma once
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>

#include "common/core/result.hpp"
#include "server/replay/subcommand_options.hpp"

namespace runstone {

/// The exit codes of runstone-replay, which scripts may rely on.
enum ReplayExit { kReplayEqual = 0, kReplayDifferent = 1, kReplayCannotRead = 2 };

struct Subcommand {
  const char* name;
  const char* help;
  /// Declares the options. Returns the function that runs the subcommand once they are parsed.
  std::function<std::function<Result<int, std::string>(std::ostream& out)>(SubcommandOptions&)> add;
};

/// `declare(command_line, options)` declares the options. `run(options, out)` prints the table to
/// `out` and returns the exit code, or an error of one line, which means the exit code
/// kReplayCannotRead.
template <class Options>
Subcommand make_subcommand(const char* name, const char* help,
                           void (*declare)(SubcommandOptions&, Options&),
                           Result<int, std::string> (*run)(const Options&, std::ostream&)) {
  return {name, help, [declare, run](SubcommandOptions& command_line) {
            auto options = std::make_shared<Options>();
            declare(command_line, *options);
            return [options, run](std::ostream& out) { return run(*options, out); };
          }};
}

}  // namespace runstone
