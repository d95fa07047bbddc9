#include "server/backup/folder_program.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>
#include <set>
#include <utility>
#include <vector>

#include "common/core/hex.hpp"
#include "common/core/utc_text.hpp"
#include "common/os/low_priority.hpp"
#include "common/os/progress_line.hpp"
#include "server/backup/backup_folder.hpp"
#include "server/backup/copy_text.hpp"
#include "server/backup/folder_backup.hpp"
#include "server/store/store.hpp"

namespace runstone {
namespace {

using Entries = std::vector<BackupFolder::Entry>;

void print_pruned(const BackupFolder::Pruned& pruned, std::ostream& out) {
  for (const std::string& name : pruned.names) out << "removed     " << name << '\n';
  if (pruned.freed_bytes > 0) out << "freed       " << pruned.freed_bytes << " bytes\n";
  if (!pruned.warning.empty()) out << "warning     " << pruned.warning << '\n';
}

Result<void, std::string> add_to_folder(const BackupFolderRequest& request, TimeUs now_us,
                                        const BackupPace& pace, std::ostream& out) {
  // A backup in the world's folder would be lost together with it, and fill the same disk.
  if (is_inside(request.folder, request.world))
    return failure(request.folder + ": lies in " + request.world);
  if (is_inside(request.world, request.folder))
    return failure(request.world + ": lies in " + request.folder);
  const auto world = open_world(request.world, StoreAccess::read_only);
  if (!world) return failure(world.error().message());
  auto folder = BackupFolder::open_for(request.folder, (*world)->meta().world_id);
  if (!folder) return failure(folder.error());
  const auto added = [&] {
    ProgressLine line("pages copied", request.progress);
    return add_backup(
        request.world, *folder, now_us, pace,
        [&](std::uint64_t done, std::uint64_t all) { line.show(done, all); }, out);
  }();
  if (!added) return failure(added.error());
  out << "backed up   " << request.world << " to " << request.folder << '\n'
      << "backup      " << backup_name(added->manifest.taken_us) << '\n';
  print_copy(added->copy, out);
  out << "stored      " << added->manifest.new_bytes << " new bytes of " << added->manifest.bytes()
      << ", in " << seconds_text(added->store_s) << '\n';
  const auto names = folder->to_remove(request.policy, now_us);
  if (names && names->empty() && !added->found_interrupted) return {};  // nothing to remove
  const auto pruned = names ? folder->remove(*names)
                            : Result<BackupFolder::Pruned, std::string>(failure(names.error()));
  if (pruned) {
    print_pruned(*pruned, out);
  } else {
    out << "warning     older backups are not removed: " << pruned.error() << '\n';
  }
  return {};
}

nlohmann::json json_of(const BackupFolder::Entry& entry) {
  nlohmann::json out = {{"name", entry.name}, {"taken", utc_text(entry.taken_us)}};
  if (entry.error.empty()) {
    out["epoch"] = entry.manifest.epoch;
    out["seq"] = entry.manifest.seq;
    out["bytes"] = entry.manifest.bytes();
    out["new_bytes"] = entry.manifest.new_bytes;
  } else {
    out["error"] = entry.error;
  }
  return out;
}

void print_entry(const BackupFolder::Entry& entry, std::ostream& out) {
  out << entry.name;
  if (entry.error.empty()) {
    out << "  epoch=" << entry.manifest.epoch << " seq=" << entry.manifest.seq
        << " bytes=" << entry.manifest.bytes() << " new_bytes=" << entry.manifest.new_bytes << '\n';
  } else {
    out << "  DAMAGED: " << entry.error << '\n';
  }
}

void print_entries(const BackupFolder& folder, const Entries& entries, bool json,
                   std::ostream& out) {
  if (json) {
    nlohmann::json list = nlohmann::json::array();
    for (const auto& entry : entries) list.push_back(json_of(entry));
    const nlohmann::json all = {{"world", to_hex(folder.world())}, {"backups", list}};
    out << all.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    return;
  }
  out << "world " << to_hex(folder.world()) << ", backups " << entries.size() << '\n';
  for (const auto& entry : entries) print_entry(entry, out);
}

Result<void, std::string> list_folder(const BackupFolderRequest& request, TimeUs now_us,
                                      std::ostream& out) {
  const auto folder = BackupFolder::open(request.folder);
  if (!folder) return failure(folder.error());
  const auto entries = folder->entries();
  if (!entries) return failure(entries.error());
  print_entries(*folder, *entries, request.json, out);
  if (request.json || entries->empty() || entries->back().taken_us <= now_us) return {};
  out << "warning     " << entries->back().name
      << " is dated in the future: a clock was wrong, or is. It stays, and takes no place of another "
         "backup\n";
  return {};
}

Result<void, std::string> prune_folder(const BackupFolderRequest& request, TimeUs now_us,
                                       std::ostream& out) {
  if (request.policy.keeps_all()) {
    return failure(
        "prune: say what stays: --keep-hourly, --keep-daily or --keep-weekly with a number above 0");
  }
  auto folder = BackupFolder::open(request.folder);
  if (!folder) return failure(folder.error());
  if (auto locked = folder->lock(); !locked) return failure(locked.error());
  const auto names = folder->to_remove(request.policy, now_us);
  if (!names) return failure(names.error());
  if (request.is_rehearsal) {
    for (const std::string& name : *names) out << "would go    " << name << '\n';
    if (names->empty()) out << "every backup stays\n";
    return {};
  }
  const auto pruned = folder->remove(*names);
  if (!pruned) return failure(pruned.error());
  print_pruned(*pruned, out);
  if (pruned->names.empty()) out << "every backup stays\n";
  return {};
}

Result<void, std::string> verify_folder(const BackupFolderRequest& request, std::ostream& out) {
  auto folder = BackupFolder::open(request.folder);
  if (!folder) return failure(folder.error());
  const auto unlocked = folder->lock_for_reading();
  if (!unlocked) return failure(unlocked.error());
  if (!unlocked->empty() && !request.json) out << "warning     " << *unlocked << '\n';
  auto names = folder->names();
  if (!names) return failure(names.error());
  if (!request.backup.empty()) {
    if (std::ranges::find(*names, request.backup) == names->end())
      return failure(request.folder + ": holds no backup " + request.backup);
    names = std::vector<std::string>{request.backup};
  }
  Entries entries;
  std::size_t damaged = 0;
  std::set<BlockHash> sound;
  for (const std::string& name : *names) {
    BackupFolder::Entry entry = folder->read(name);
    if (entry.error.empty()) {
      if (auto checked = check_blocks(entry.manifest, folder->blocks(), sound); !checked)
        entry.error = checked.error();
    }
    for (BackedUpFile& file : entry.manifest.files) file.blocks = {};
    damaged += entry.error.empty() ? 0 : 1;
    entries.push_back(std::move(entry));
  }
  print_entries(*folder, entries, request.json, out);
  if (damaged == 0) return {};
  return failure(
      request.folder + ": " + std::to_string(damaged) + " of " + std::to_string(entries.size()) +
      " backups are damaged: the next backup makes blocks anew that the world still has");
}

}  // namespace

Result<void, std::string> run_backup_folder(const BackupFolderRequest& request, TimeUs now_us,
                                            std::ostream& out, const BackupPace& pace) {
  lower_priority();
  lower_disk_priority();
  switch (request.action) {
    case BackupFolderRequest::Action::add:
      return add_to_folder(request, now_us, pace, out);
    case BackupFolderRequest::Action::list:
      return list_folder(request, now_us, out);
    case BackupFolderRequest::Action::prune:
      return prune_folder(request, now_us, out);
    case BackupFolderRequest::Action::verify:
      break;
  }
  return verify_folder(request, out);
}

}  // namespace runstone
