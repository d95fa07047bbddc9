#include "common/os/new_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <ostream>
#include <system_error>
#include <vector>

#include "common/os/folder_entries.hpp"

namespace runstone {
namespace {

namespace fs = std::filesystem;
using Made = Result<void, std::string>;

constexpr const char* kInside = ".partial";
constexpr const char* kFileSystems = "lost+found";  // at the root of a file system

std::string lock_in(const std::string& folder) { return folder + "/partial.lock"; }

/// Where the files of a folder are written.
struct Unfinished {
  std::string target;   // to which no symbolic link leads further
  std::string partial;  // the folder of unfinished files
  bool is_inside = false;
};

bool is_empty(const std::string& folder, std::error_code& error) {
  const fs::directory_iterator end;
  for (fs::directory_iterator entry(folder, error); !error && entry != end;
       entry.increment(error)) {
    const auto name = entry->path().filename();
    if (name != kInside && name != kFileSystems) return false;
  }
  return true;
}

Result<Unfinished, std::string> unfinished_of(const std::string& target) {
  const std::string whole = resolved_name(target);
  std::error_code error;
  if (fs::exists(whole, error)) {
    const std::string folder = fs::canonical(whole, error).string();
    if (!fs::is_directory(whole, error)) return failure(whole + ": is there and is no folder");
    if (!is_empty(folder, error) || error) return failure(whole + ": is not empty");
    return Unfinished{folder, folder + "/" + kInside, true};
  }
  if (fs::is_symlink(fs::symlink_status(whole, error)))
    return failure(whole + ": is a symbolic link to a folder that does not exist");
  const auto parent = fs::path(whole).parent_path();
  if (!fs::is_directory(parent, error)) return failure(parent.string() + ": is no folder");
  return Unfinished{whole, whole + ".partial", false};
}

/// Fails if what has the name of the unfinished files is not what an interrupted program left.
Made check_interrupted(const std::string& partial) {
  std::error_code error;
  const auto status = fs::symlink_status(partial, error);
  if (!fs::exists(status)) return {};
  // It is removed only if it is surely ours. A folder without the lock may be empty: a program can
  // be killed before it has made the lock.
  const bool is_ours = fs::is_directory(status) &&
                       (fs::exists(lock_in(partial), error) || fs::is_empty(partial, error));
  if (is_ours) return {};
  return failure(partial +
                 ": is there and is not what an interrupted program leaves: move it away");
}

/// Removes what an interrupted program left. Does nothing if there is nothing.
Made remove_interrupted(const std::string& partial, std::ostream& out) {
  std::error_code error;
  if (auto checked = check_interrupted(partial); !checked) return checked;
  if (!fs::exists(partial, error)) return {};
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
  return failure(path.string() + ": cannot be synced: " + std::strerror(wrong));
}

}  // namespace

std::string resolved_name(const std::string& folder) {
  std::error_code error;
  auto whole = fs::absolute(folder, error).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();  // "valley/"
  return (fs::weakly_canonical(whole.parent_path(), error) / whole.filename()).string();
}

Made NewFolder::check(const std::string& target) {
  const auto place = unfinished_of(target);
  if (!place) return failure(place.error());
  const std::string parent = fs::path(place->partial).parent_path().string();
  if (::access(parent.c_str(), W_OK | X_OK) != 0)
    return failure(parent + ": cannot be written: " + std::strerror(errno));
  return check_interrupted(place->partial);
}

Result<NewFolder, std::string> NewFolder::make(const std::string& target, std::ostream& out) {
  auto place = unfinished_of(target);
  if (!place) return failure(place.error());
  const std::string& partial = place->partial;
  if (auto removed = remove_interrupted(partial, out); !removed) return failure(removed.error());
  if (::mkdir(partial.c_str(), 0700) != 0)
    return failure(partial + ": cannot be made: " + std::strerror(errno));
  auto lock = FileLock::take(lock_in(partial));
  if (!lock) return failure(lock_in(partial) + ": " + lock.error().what);
  return NewFolder(place->target, partial, place->is_inside, *std::move(lock));
}

NewFolder::~NewFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

/// Moves the files into the empty folder that holds the folder of unfinished files.
Made NewFolder::move_up(const std::string& last) {
  std::error_code error;
  if (!is_empty(target_, error) || error) return failure(target_ + ": is not empty any more");
  auto files = folder_entries(path_);
  if (!files) return failure(files.error());
  std::erase_if(*files, [&](const fs::path& file) {
    return file == lock_in(path_) || file.filename() == last;
  });
  if (fs::exists(path_ + "/" + last, error)) files->push_back(path_ + "/" + last);
  for (const fs::path& file : *files) {
    fs::rename(file, target_ / file.filename(), error);
    if (error)
      return failure(target_ + ": cannot get " + file.filename().string() + ": " + error.message());
  }
  fs::remove_all(path_, error);
  if (error) return failure(path_ + ": cannot be removed: " + error.message());
  path_.clear();
  return sync(target_);
}

/// Gives the folder of unfinished files its name.
Made NewFolder::rename() {
  // An empty folder of that name is replaced. One that has been filled meanwhile is an error.
  if (::rename(path_.c_str(), target_.c_str()) != 0)
    return failure(target_ + ": cannot be made: " + std::strerror(errno));
  path_.clear();
  // While the lock is there, a folder that keeps its old name is known as an interrupted one.
  std::error_code error;
  fs::remove(lock_in(target_), error);
  if (error) return failure(lock_in(target_) + ": cannot be removed: " + error.message());
  if (auto synced = sync(target_); !synced) return synced;
  return sync(fs::path(target_).parent_path());
}

Made NewFolder::finish(const std::string& last) {
  const auto files = folder_entries(path_);
  if (!files) return failure(files.error());
  for (const fs::path& file : *files) {
    if (auto synced = sync(file); !synced) return synced;
  }
  if (auto synced = sync(path_); !synced) return synced;
  return is_inside_ ? move_up(last) : rename();
}

}  // namespace runstone
