// ServerOptions: the command line of runstone-server as a value.
#pragma once
#include <map>
#include <optional>
#include <string>

#include "server/admin/compact_program.hpp"
#include "server/admin/control_program.hpp"
#include "server/admin/copy_program.hpp"
#include "server/backup/backup_program.hpp"
#include "server/backup/folder_program.hpp"
#include "server/backup/world_pack.hpp"
#include "server/import/import_program.hpp"
#include "server/repair/repair_program.hpp"
#include "server/store/world_folder.hpp"

namespace runstone {

struct ServerOptions {
  std::map<std::string, std::string> settings;       // text by field of ServerConfig
  std::string config_file, port_file, digests_file;  // empty: none
  bool print_config = false;
  bool create = false;         // make the world if its place holds none, whatever the place is
  bool accept_losses = false;  // start a world that has lost edits, players or watermarks
  WorldCreation creation;
  std::optional<ImportRequest> import;               // the import subcommand
  std::optional<CompactRequest> compact;             // the compact subcommand
  std::optional<CopyRequest> copy;                   // the copy subcommand
  std::optional<BackupRequest> backup;               // the backup subcommand without one of its own
  std::optional<BackupFolderRequest> backup_folder;  // backup add, list, prune, verify
  std::optional<PackRequest> pack;                   // the pack subcommand
  std::optional<RestoreRequest> restore;             // the restore subcommand
  std::optional<RepairRequest> repair;               // the repair subcommand
  bool console = false;          // read commands from standard input even if it is no terminal
  bool stop_with_input = false;  // stop when standard input ends
  std::optional<ControlRequest> control;  // the control subcommand
};

/// The options, or the exit code of a program that has nothing more to do: 0 after help or version,
/// 2 after an error. The help text or the error was printed.
struct ParsedServerOptions {
  std::optional<ServerOptions> options;
  int exit_code = 0;
};
ParsedServerOptions parse_server_options(int argc, const char* const* argv);

}  // namespace runstone
