// ServerOptions: what the command line of runstone-server says.
#pragma once
#include <map>
#include <optional>
#include <string>

#include "server/admin/compact_program.hpp"
#include "server/admin/control_program.hpp"
#include "server/import/import_program.hpp"
#include "server/store/world_folder.hpp"

namespace runstone {

struct ServerOptions {
  std::map<std::string, std::string> settings;       // by field of ServerConfig, as given
  std::string config_file, port_file, digests_file;  // empty: none
  bool print_config = false;
  WorldCreation creation;
  std::optional<ImportRequest> import;    // the import subcommand
  std::optional<CompactRequest> compact;  // the compact subcommand
  bool console = false;                   // read commands even if standard input is no terminal
  std::optional<ControlRequest> control;  // the control subcommand
};

/// The options, or the exit code of a program that has nothing more to do: 0 after help or version, 2 after a
/// mistake. Both were printed.
struct ParsedServerOptions {
  std::optional<ServerOptions> options;
  int exit_code = 0;
};
ParsedServerOptions parse_server_options(int argc, const char* const* argv);

}  // namespace runstone
