#include "server/backup/backup_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>
#include <system_error>

#include "common/core/hex.hpp"
#include "common/os/file_writer.hpp"
#include "common/os/folder_entries.hpp"
#include "common/os/private_file.hpp"

namespace runstone {
namespace {

constexpr std::string_view kFolderMark = "runstone-backups", kManifestEnd = ".backup";
constexpr std::string_view kMarkLine = "runstone backups 1\nworld ";
constexpr std::size_t kManifestBytesMax = std::size_t{4} << 30;  // of a world of about 2 TiB

std::string mark_of(const std::string& folder) { return folder + "/" + std::string(kFolderMark); }

/// Reads the mark of a folder of backups. Returns the world.
Result<WorldId, std::string> read_folder_mark(const std::string& folder) {
  const std::string file = mark_of(folder);
  const auto text = read_file(file, kSmallFileBytesMax);
  if (!text) return failure(text.error());
  WorldId world{};
  const std::string_view line = *text;
  if (line.starts_with(kMarkLine) && line.ends_with('\n') &&
      read_hex(line.substr(kMarkLine.size(), 2 * world.size()), world) &&
      line.size() == kMarkLine.size() + 2 * world.size() + 1)
    return world;
  if (line.starts_with("runstone backups ") && !line.starts_with(kMarkLine))
    return failure(file + ": is of a newer version of Runstone");
  return failure(file + ": is damaged");
}

/// Returns true if nothing but what a file system or a first try leaves is in the folder.
Result<bool, std::string> is_unused(const std::string& folder) {
  const auto entries = folder_entries(folder);
  if (!entries) return failure(entries.error());
  return std::ranges::all_of(*entries, [](const std::filesystem::path& entry) {
    const std::string name = entry.filename().string();
    return name == "lost+found" || name == "backups.lock" || name == "server.lock";
  });
}

}  // namespace

bool BackupFolder::is_one(const std::string& folder) {
  std::error_code ignored;
  return std::filesystem::exists(mark_of(folder), ignored);
}

Result<BackupFolder, std::string> BackupFolder::open(const std::string& folder) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored))
    return failure(folder + ": is no folder: mount its disk, or name another one");
  if (!is_one(folder))
    return failure(folder + ": holds no backups (the file " + std::string(kFolderMark) +
                   " is not there)");
  const auto world = read_folder_mark(folder);
  if (!world) return failure(world.error());
  return BackupFolder(folder, *world);
}

Result<BackupFolder, std::string> BackupFolder::open_for(const std::string& folder,
                                                         const WorldId& world) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored))
    return failure(folder + ": is no folder: make it, or mount its disk");
  BackupFolder opened(folder, world);
  if (!is_one(folder)) {
    const auto unused = is_unused(folder);
    if (!unused) return failure(unused.error());
    if (!*unused)
      return failure(folder +
                     ": holds files that are no backups: give the backups a folder of their own");
  }
  auto lock = FileLock::take(folder + "/backups.lock");
  if (!lock) {
    return failure(folder + (lock.error().is_held ? ": another program is using it"
                                                  : "/backups.lock: " + lock.error().what));
  }
  opened.lock_ = *std::move(lock);
  if (!is_one(folder)) {
    const auto marked =
        write_private_file(mark_of(folder), std::string(kMarkLine) + to_hex(world) + "\n");
    if (!marked) return failure(marked.error());
  }
  const auto marked = read_folder_mark(folder);
  if (!marked) return failure(marked.error());
  if (*marked != world) {
    return failure(folder + ": holds backups of another world, " + to_hex(*marked) +
                   ": give each world a folder of its own");
  }
  return opened;
}

Result<void, std::string> BackupFolder::lock() {
  if (lock_) return {};
  auto lock = FileLock::take(path_ + "/backups.lock");
  if (lock) {
    lock_ = *std::move(lock);
  } else if (lock.error().is_held) {
    return failure(path_ + ": another program is using it");
  }
  return {};
}

Result<std::vector<std::string>, std::string> BackupFolder::names() const {
  const auto entries = folder_entries(path_);
  if (!entries) return failure(entries.error());
  std::vector<std::string> all;
  for (const std::filesystem::path& file : *entries) {
    std::string name = file.filename().string();
    if (!name.ends_with(kManifestEnd)) continue;
    name.resize(name.size() - kManifestEnd.size());
    if (time_of_backup(name)) all.push_back(std::move(name));
  }
  std::ranges::sort(all);  // the order of the names is that of the times
  return all;
}

BackupFolder::Entry BackupFolder::read(const std::string& name) const {
  Entry entry{name, time_of_backup(name).value_or(0), {}, {}};
  const std::string file = file_of(name);
  const auto text = read_file(file, kManifestBytesMax);
  if (!text) {
    entry.error = text.error();
  } else if (auto manifest = parse_manifest(*text); !manifest) {
    entry.error = file + ": " + manifest.error();
  } else if (manifest->world != world_ || manifest->taken_us != entry.taken_us) {
    entry.error = file + ": is of another world or another time";
  } else {
    entry.manifest = *std::move(manifest);
  }
  return entry;
}

Result<std::vector<BackupFolder::Entry>, std::string> BackupFolder::entries() const {
  const auto all = names();
  if (!all) return failure(all.error());
  std::vector<Entry> entries;
  for (const std::string& name : *all) {
    entries.push_back(read(name));
    for (BackedUpFile& file : entries.back().manifest.files) file.blocks = {};
  }
  return entries;
}

Result<BackupFolder::Entry, std::string> BackupFolder::find(const std::string& name) const {
  const auto all = names();
  if (!all) return failure(all.error());
  if (all->empty()) return failure(path_ + ": holds no backup yet");
  if (!name.empty() && std::ranges::find(*all, name) == all->end()) {
    return failure(path_ + ": holds no backup " + name +
                   ": `runstone-server backup list` names them");
  }
  Entry found = read(name.empty() ? all->back() : name);
  if (found.error.empty()) return found;
  return failure(found.error + ": choose an older backup, which `backup list` names");
}

Result<void, std::string> BackupFolder::add(const BackupManifest& manifest) {
  const std::string file = file_of(backup_name(manifest.taken_us));
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored))
    return failure(file + ": is there: a backup of this second was made already");
  if (auto synced = blocks_.sync(); !synced) return synced;
  return write_private_file(file, manifest_text(manifest));
}

Result<std::vector<std::string>, std::string> BackupFolder::to_remove(
    const BackupPolicy& policy) const {
  const auto all = entries();
  if (!all) return failure(all.error());
  std::vector<TimeUs> times;
  for (const Entry& entry : *all) {
    if (entry.error.empty()) times.push_back(entry.taken_us);
  }
  std::vector<std::string> names;
  for (const TimeUs time : backups_to_remove(std::move(times), policy))
    names.push_back(backup_name(time));
  return names;
}

Result<BackupFolder::Pruned, std::string> BackupFolder::remove(
    const std::vector<std::string>& names) {
  Pruned pruned;
  std::error_code error;
  for (const std::string& name : names) {
    if (!std::filesystem::remove(file_of(name), error) || error)
      return failure(file_of(name) + ": cannot be removed: " + error.message());
    pruned.names.push_back(name);
  }
  // The removed names must be on disk before the first of their blocks is gone.
  if (!names.empty()) sync_folder_of(file_of(names.front()));
  const auto left = this->names();
  if (!left) return failure(left.error());
  std::set<BlockHash> used;
  for (const std::string& name : *left) {
    const Entry entry = read(name);
    if (!entry.error.empty()) {
      pruned.warning = entry.error + ": remove this file to get the space of removed backups back";
      return pruned;
    }
    for (const BackedUpFile& file : entry.manifest.files)
      used.insert(file.blocks.begin(), file.blocks.end());
  }
  const auto freed = blocks_.keep_only(used);
  if (!freed) return failure(freed.error());
  pruned.freed_bytes = *freed;
  return pruned;
}

}  // namespace runstone
