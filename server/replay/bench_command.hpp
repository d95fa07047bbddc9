// runstone-replay bench: how fast a world's log is read, and how fast the world is rebuilt from it.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>

#include "common/core/result.hpp"
#include "server/history/named_moment.hpp"
#include "server/replay/subcommand_options.hpp"

namespace runstone {

struct BenchOptions {
  CommonOptions common;
  std::optional<NamedMoment> at;  // end of the replay; default: the end of the log
  std::uint64_t rounds = 5;       // 1..1000
};

void declare_bench(SubcommandOptions& command_line, BenchOptions& options);

/// Times reading and rebuilding in alternation and prints a table; the JSON report has every time.
/// Fails if the replay finds a difference. Memory: all edited chunks as runs.
Result<int, std::string> run_bench(const BenchOptions& options, std::ostream& out);

}  // namespace runstone
