#include "tests/bench/wire/bytes_options.hpp"

#include <CLI/CLI.hpp>

#include "tests/bench/harness/common_options.hpp"
#include "tests/bench/worlds/lit_chunk.hpp"

namespace runstone::bench {

CLI::App* add_bytes_command(CLI::App& app, BenchOptions& options) {
  options.repetitions = 9;
  CLI::App* bytes =
      app.add_subcommand("bytes", "forms to send a chunk in: bytes, and time both ways");
  const auto worlds = byte_world_names();
  add_world_options(*bytes, options, {worlds.begin(), worlds.end()});
  add_file_options(*bytes, options);
  add_repetitions_option(*bytes, options, "--min-runs",
                         "times that each chunk is coded in each form");
  return bytes;
}

}  // namespace runstone::bench
