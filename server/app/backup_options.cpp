#include "server/app/backup_options.hpp"

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "server/store/place_rule.hpp"

namespace runstone {
namespace {

constexpr const char* kProgressHelp = "print progress even if standard error is no terminal";

void add_policy(CLI::App& app, BackupPolicy& policy) {
  const CLI::Range numbers(0, 100'000);
  app.add_option("--keep-hourly", policy.hourly,
                 "hours of which the newest backup stays; default: 0")
      ->check(numbers);
  app.add_option("--keep-daily", policy.daily, "days of which the newest backup stays; default: 0")
      ->check(numbers);
  app.add_option("--keep-weekly", policy.weekly,
                 "weeks of which the newest backup stays; default: 0")
      ->check(numbers);
}

/// Adds one of the subcommands of `backup`. Parsing it puts its request into `out`.
CLI::App* add_folder_command(CLI::App& backup, BackupOptions& out,
                             const std::shared_ptr<BackupFolderRequest>& request, const char* name,
                             const char* help) {
  CLI::App* const made = backup.add_subcommand(name, help);
  made->add_option("--folder", request->folder, "folder that holds the backups of one world")
      ->required()
      ->check(folder_refusal);
  made->callback([request, &out] { out.folder = *request; });
  return made;
}

std::shared_ptr<BackupFolderRequest> request_to(BackupFolderRequest::Action action) {
  auto request = std::make_shared<BackupFolderRequest>();
  request->action = action;
  return request;
}

void add_folder_commands(CLI::App& backup, BackupOptions& out) {
  using Action = BackupFolderRequest::Action;
  const auto add = request_to(Action::add), list = request_to(Action::list),
             prune = request_to(Action::prune), verify = request_to(Action::verify);
  CLI::App* const adds =
      add_folder_command(backup, out, add, "add",
                         "add a verified backup to a folder, also while a server runs the world; "
                         "what an older one has is not stored again");
  adds->add_option("--world", add->world, "folder of the world")->required()->check(folder_refusal);
  add_policy(*adds, add->policy);
  adds->footer("Without a --keep option that is above 0, older backups stay.");
  adds->add_flag("--progress", add->progress, kProgressHelp);
  CLI::App* const lists =
      add_folder_command(backup, out, list, "list", "print the backups of a folder");
  lists->add_flag("--json", list->json, "print JSON");
  CLI::App* const prunes = add_folder_command(
      backup, out, prune, "prune", "remove the backups of a folder that a policy does not keep");
  add_policy(*prunes, prune->policy);
  prunes->add_flag("--dry-run", prune->is_rehearsal, "print what would be removed");
  CLI::App* const verifies = add_folder_command(
      backup, out, verify, "verify", "read the backups of a folder and compare all their hashes");
  verifies->add_option("--backup", verify->backup, "the name of one backup; default: all");
  verifies->add_flag("--json", verify->json, "print JSON");
}

}  // namespace

CLI::App* add_backup(CLI::App& app, BackupOptions& out) {
  CLI::App* const backup = app.add_subcommand(
      "backup", "copy a world, also while a server runs it, and verify the copy");
  const auto request = std::make_shared<BackupRequest>();
  const CLI::Option* const world =
      backup->add_option("--world", request->world, "folder of the world")->check(folder_refusal);
  const CLI::Option* const to =
      backup->add_option("--to", request->to, "the new folder; empty, or not there")
          ->check(folder_refusal);
  backup->add_flag("--progress", request->progress, kProgressHelp);
  backup->require_subcommand(0, 1);
  add_folder_commands(*backup, out);
  backup->callback([backup, request, world, to, &out] {
    if (!backup->get_subcommands().empty()) {
      if (world->count() + to->count() > 0)
        throw CLI::ExcludesError(backup->get_subcommands().front()->get_name(),
                                 "an option in front of it");
      return;
    }
    if (world->count() == 0) throw CLI::RequiredError("--world");
    if (to->count() == 0) throw CLI::RequiredError("--to");
    out.copy = *request;
  });
  return backup;
}

CLI::App* add_pack(CLI::App& app, PackRequest& out) {
  CLI::App* const pack = app.add_subcommand(
      "pack", "make one file that holds all of a world, also while a server runs it");
  pack->add_option("WORLD", out.world, "folder of the world")->required()->check(folder_refusal);
  pack->add_option("FILE", out.file, "the new file, such as valley.tar")->required();
  pack->add_flag("--progress", out.progress, kProgressHelp);
  return pack;
}

CLI::App* add_restore(CLI::App& app, RestoreRequest& out) {
  CLI::App* const restore = app.add_subcommand("restore", "make a world of a backup");
  restore
      ->add_option("--from", out.from,
                   "folder of the backup, folder that `backup add` fills, or file of `pack`")
      ->required()
      ->check(folder_refusal);
  restore->add_option("--backup", out.backup,
                      "the name of a backup that `backup list` prints; default: the newest one");
  restore->add_option("--world", out.world, "folder of the new world; empty, or not there")
      ->required()
      ->check(folder_refusal);
  restore->add_flag("--progress", out.progress, kProgressHelp);
  return restore;
}

}  // namespace runstone
