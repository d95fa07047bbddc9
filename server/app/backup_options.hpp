// The command lines of runstone-server backup, pack and restore.
#pragma once
#include <optional>

#include "server/backup/backup_program.hpp"
#include "server/backup/folder_program.hpp"
#include "server/backup/world_pack.hpp"

namespace CLI {
class App;
}

namespace runstone {

/// The request of `runstone-server backup`. After parsing, exactly one member is set.
struct BackupOptions {
  std::optional<BackupRequest> copy;          // backup --world DIR --to NEW
  std::optional<BackupFolderRequest> folder;  // backup add, list, prune, verify
};

/// Add the subcommands to a program. Parsing fills `out`, which must outlive `app`. They return the
/// subcommand.
CLI::App* add_backup(CLI::App& app, BackupOptions& out);
CLI::App* add_pack(CLI::App& app, PackRequest& out);
CLI::App* add_restore(CLI::App& app, RestoreRequest& out);

}  // namespace runstone
