#include "server/backup/partial_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <ostream>
#include <system_error>

namespace runstone {
namespace {

namespace fs = std::filesystem;
using Made = Result<void, std::string>;

std::string lock_in(const std::string& folder) { return folder + "/partial.lock"; }

Made check_target(const std::string& target) {
  std::error_code error;
  const auto status = fs::symlink_status(target, error);
  if (fs::is_symlink(status)) {
    return failure(target + ": is a symbolic link: name the folder itself");
  }
  if (fs::exists(status)) {
    if (!fs::is_directory(status)) return failure(target + ": is there and is no folder");
    if (!fs::is_empty(target, error) || error) return failure(target + ": is not empty");
  }
  const auto parent = fs::path(target).parent_path();
  if (!fs::is_directory(parent, error)) return failure(parent.string() + ": is no folder");
  return {};
}

/// Removes what an interrupted program left. Does nothing if there is nothing.
Made remove_interrupted(const std::string& partial, std::ostream& out) {
  std::error_code error;
  const auto status = fs::symlink_status(partial, error);
  if (!fs::exists(status)) return {};
  // It is removed only if it is surely ours. A folder without the lock may be empty: a program can
  // be killed before it has made the lock.
  const bool is_ours = fs::is_directory(status) &&
                       (fs::exists(lock_in(partial), error) || fs::is_empty(partial, error));
  if (!is_ours) {
    return failure(partial +
                   ": is there and is not what an interrupted backup leaves: move it away");
  }
  const auto lock = FileLock::take(lock_in(partial));
  if (!lock) {
    return failure(partial + (lock.error().is_held ? ": another program is writing it"
                                                   : ": " + lock.error().what));
  }
  fs::remove_all(partial, error);
  if (error) return failure(partial + ": cannot be removed: " + error.message());
  out << "removed     " << partial << ", which was interrupted\n";
  return {};
}

Made sync(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  const bool is_synced = descriptor >= 0 && ::fsync(descriptor) == 0;
  const int wrong = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (is_synced) return {};
  return failure(path.string() + ": cannot be synced: " + std::generic_category().message(wrong));
}

}  // namespace

std::string resolved_name(const std::string& folder) {
  std::error_code error;
  auto whole = fs::absolute(folder, error).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();  // "valley/"
  return (fs::weakly_canonical(whole.parent_path(), error) / whole.filename()).string();
}

Result<PartialFolder, std::string> PartialFolder::make(const std::string& target,
                                                       std::ostream& out) {
  const std::string whole = resolved_name(target);
  if (auto allowed = check_target(whole); !allowed) return failure(allowed.error());
  const std::string partial = whole + ".partial";
  if (auto removed = remove_interrupted(partial, out); !removed) return failure(removed.error());
  if (::mkdir(partial.c_str(), 0700) != 0) {
    return failure(partial + ": cannot be made: " + std::generic_category().message(errno));
  }
  auto lock = FileLock::take(lock_in(partial));
  if (!lock) return failure(lock_in(partial) + ": " + lock.error().what);
  return PartialFolder(whole, partial, *std::move(lock));
}

PartialFolder::~PartialFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

Made PartialFolder::finish() {
  std::error_code error;
  for (const auto& file : fs::directory_iterator(path_, error)) {
    if (auto synced = sync(file.path()); !synced) return synced;
  }
  if (auto synced = sync(path_); !synced) return synced;
  // An empty folder of that name is replaced. One that has been filled meanwhile is an error.
  if (::rename(path_.c_str(), target_.c_str()) != 0) {
    return failure(target_ + ": cannot be made: " + std::generic_category().message(errno));
  }
  path_.clear();
  // While the lock is there, a folder that keeps its old name is known as what is left of a backup.
  fs::remove(lock_in(target_), error);
  if (error) return failure(lock_in(target_) + ": cannot be removed: " + error.message());
  if (auto synced = sync(target_); !synced) return synced;
  return sync(fs::path(target_).parent_path());
}

}  // namespace runstone
