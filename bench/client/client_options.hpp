// ClientBenchOptions: the command line of `runstone-bench client`.
#pragma once
#include <string>

namespace CLI {
class App;
}

namespace runstone::bench {

struct ClientBenchOptions {
  std::string luanti;    // folder of a Luanti world
  unsigned edits = 200;  // of the burst, in as many chunks
  unsigned bursts = 5;
  unsigned own_edits = 20;
  unsigned frames = 40;            // of each variant in each world
  int width = 1280, height = 720;  // pixels
  std::string json;                // file to write; empty: none
};

/// Adds the subcommand. `options` must outlive the parse.
CLI::App* add_client_command(CLI::App& app, ClientBenchOptions& options);

}  // namespace runstone::bench
