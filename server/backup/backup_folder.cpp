#include "server/backup/backup_folder.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <set>
#include <string_view>
#include <system_error>
#include <tuple>

#include "common/core/hex.hpp"
#include "common/os/folder_entries.hpp"
#include "common/os/private_file.hpp"

namespace runstone {
namespace {

constexpr std::string_view kFolderMark = "runstone-backups", kManifestEnd = ".backup";
constexpr std::string_view kMarkLine = "runstone backups 1\nworld ";
constexpr std::size_t kManifestBytesMax = std::size_t{4} << 30;  // of a world of about 2 TiB
constexpr std::size_t kHeadBytesMax = 512;  // the lines above the first file have at most 200
constexpr std::string_view kHeld =
    ": another program is using it: try again when its backup is made, removed or read";

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

/// Returns true for the name of a file that was written and did not get its name: FILE.new or
/// FILE.new7.
bool is_unfinished(std::string_view name, std::string_view file) {
  constexpr std::string_view kNew = ".new";
  if (!name.starts_with(file) || !name.substr(file.size()).starts_with(kNew)) return false;
  return name.find_first_not_of("0123456789", file.size() + kNew.size()) == name.npos;
}

/// Returns the newest of the backups whose manifests have these heads. Requires one.
const BackupManifest& newest_of(const std::vector<BackupManifest>& heads, TimeUs now_us) {
  const auto rank = [now_us](const BackupManifest& head) {
    return std::tuple(head.epoch, head.seq, head.taken_us <= now_us, head.taken_us);
  };
  return *std::ranges::max_element(heads, {}, rank);
}

/// Returns true if the folder holds nothing but `lost+found`, `backups.lock`, `server.lock` and
/// unfinished marks, which a file system and a first backup that was killed leave.
Result<bool, std::string> is_unused(const std::string& folder) {
  const auto entries = folder_entries(folder);
  if (!entries) return failure(entries.error());
  return std::ranges::all_of(*entries, [](const std::filesystem::path& entry) {
    const std::string name = entry.filename().string();
    return name == "lost+found" || name == "backups.lock" || name == "server.lock" ||
           is_unfinished(name, kFolderMark);
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
    return failure(folder + (lock.error().is_held ? std::string(kHeld)
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
  const std::string file = path_ + "/backups.lock";
  auto lock = FileLock::take(file);
  if (!lock)
    return failure(lock.error().is_held ? path_ + std::string(kHeld)
                                        : file + ": " + lock.error().what);
  lock_ = *std::move(lock);
  return {};
}

Result<std::string, std::string> BackupFolder::lock_for_reading() {
  auto locked = lock();
  if (locked) return std::string();
  const std::string file = path_ + "/backups.lock";
  const std::string& place = ::access(file.c_str(), F_OK) == 0 ? file : path_;
  if (::access(place.c_str(), W_OK) == 0) return failure(locked.error());
  if (errno == EROFS) return std::string();
  if (errno != EACCES) return failure(locked.error());
  return locked.error() +
         ": it is read without a lock, so a backup that is removed meanwhile is missed";
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

BackupFolder::Entry BackupFolder::entry_of(const std::string& name,
                                           Result<BackupManifest, std::string> read) const {
  Entry entry{name, time_of_backup(name).value_or(0), {}, {}};
  if (!read) {
    entry.error = file_of(name) + ": " + read.error();
  } else if (read->world != world_ || read->taken_us != entry.taken_us) {
    entry.error = file_of(name) + ": is of another world or another time";
  } else {
    entry.manifest = *std::move(read);
  }
  return entry;
}

BackupFolder::Entry BackupFolder::read(const std::string& name) const {
  const auto text = read_file(file_of(name), kManifestBytesMax);
  if (!text) return Entry{name, time_of_backup(name).value_or(0), {}, text.error()};
  return entry_of(name, parse_manifest(*text));
}

BackupFolder::Entry BackupFolder::read_sizes(const std::string& name) const {
  const std::string file = file_of(name);
  if (const auto checked = check_file_kind(file); !checked)
    return Entry{name, time_of_backup(name).value_or(0), {}, checked.error()};
  std::ifstream in(file, std::ios::binary);
  if (!in) return entry_of(name, failure(std::string("cannot be read")));
  return entry_of(name, read_manifest_sizes(in));
}

Result<std::vector<BackupFolder::Entry>, std::string> BackupFolder::entries() const {
  const auto all = names();
  if (!all) return failure(all.error());
  std::vector<Entry> entries;
  for (const std::string& name : *all) entries.push_back(read_sizes(name));
  return entries;
}

Result<std::string, std::string> BackupFolder::newest(TimeUs now_us) const {
  const auto all = names();
  if (!all) return failure(all.error());
  if (all->empty()) return failure(path_ + ": holds no backup yet");
  std::vector<BackupManifest> heads;
  std::string damaged;  // the last one that is not of the future
  for (const std::string& name : *all) {
    std::array<char, kHeadBytesMax> text{};
    std::ifstream in(file_of(name), std::ios::binary);
    in.read(text.data(), text.size());
    auto head = parse_manifest_head({text.data(), static_cast<std::size_t>(in.gcount())});
    const TimeUs taken_us = time_of_backup(name).value_or(0);
    if (head && head->world == world_ && head->taken_us == taken_us) {
      heads.push_back(*std::move(head));
    } else if (taken_us <= now_us || damaged.empty()) {
      damaged = name;
    }
  }
  if (heads.empty()) return damaged;
  std::string found = backup_name(newest_of(heads, now_us).taken_us);
  const bool is_doubtful = damaged > found && time_of_backup(damaged).value_or(0) <= now_us;
  return is_doubtful ? damaged : found;
}

Result<BackupFolder::Entry, std::string> BackupFolder::find(const std::string& name,
                                                            TimeUs now_us) const {
  const auto all = names();
  if (!all) return failure(all.error());
  if (!name.empty() && std::ranges::find(*all, name) == all->end()) {
    return failure(path_ + ": holds no backup " + name +
                   ": `runstone-server backup list` names them");
  }
  const auto wanted = name.empty() ? newest(now_us) : name;
  if (!wanted) return failure(wanted.error());
  Entry found = read(*wanted);
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

Result<std::vector<std::string>, std::string> BackupFolder::to_remove(const BackupPolicy& policy,
                                                                      TimeUs now_us) const {
  const auto all = names();
  if (!all) return failure(all.error());
  std::vector<TimeUs> times;
  for (const std::string& name : *all) times.push_back(time_of_backup(name).value_or(0));
  // Damaged ones that do not count only let more of the others stay, so no manifest is read if
  // nothing is to be removed with them.
  if (backups_to_remove(times, policy, now_us).empty()) return std::vector<std::string>();
  std::erase_if(times, [&](TimeUs time) { return !read_sizes(backup_name(time)).error.empty(); });
  std::vector<std::string> removed;
  for (const TimeUs time : backups_to_remove(std::move(times), policy, now_us))
    removed.push_back(backup_name(time));
  return removed;
}

Result<void, std::string> BackupFolder::remove_unfinished() {
  const auto entries = folder_entries(path_);
  if (!entries) return failure(entries.error());
  for (const std::filesystem::path& path : *entries) {
    const std::string file = path.filename().string();
    const std::string name = file.substr(0, file.find('.'));
    if (!is_unfinished(file, kFolderMark) &&
        !(time_of_backup(name) && is_unfinished(file, name + std::string(kManifestEnd))))
      continue;
    std::error_code error;
    std::filesystem::remove(path, error);
    if (error) return failure(path.string() + ": cannot be removed: " + error.message());
  }
  return {};
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
  if (auto removed = remove_unfinished(); !removed) return failure(removed.error());
  // The removed names must be on disk before the first of their blocks is gone.
  if (auto synced = sync_names(path_); !synced) return failure(synced.error());
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
