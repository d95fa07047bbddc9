// runstone-replay play: plays a world's log into a live server. Only clients join a server, so
// runstone-bot plays it, as a child process.
#pragma once
#include <iosfwd>
#include <optional>
#include <string>

#include "common/core/result.hpp"
#include "server/history/named_moment.hpp"
#include "server/replay/subcommand_options.hpp"

namespace runstone {

struct PlayOptions {
  CommonOptions common;           // json: the report of runstone-bot
  std::string connect;            // HOST:PORT of the live server
  std::optional<NamedMoment> at;  // last edit; default: the end of the log
  std::string speed = "1";        // times the recorded speed, or "max"; runstone-bot parses it too
  std::string bot;                // path of runstone-bot; empty: see sibling_program()
  bool insecure = false;          // the live server does not encrypt
};

void declare_play(SubcommandOptions& command_line, PlayOptions& options);

/// Exports the log to a temporary file, starts runstone-bot on it and waits for its end. Returns
/// its exit code. Removes the file in every case. Meanwhile SIGINT and SIGTERM are passed on to the
/// child. Blocks.
Result<int, std::string> run_play(const PlayOptions& options, std::ostream& out);

}  // namespace runstone
