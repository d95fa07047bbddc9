#include "client/local/local_worlds.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <tuple>

#include "common/os/user_folders.hpp"

namespace runstone {
namespace {

constexpr std::size_t kWorldNameBytesMax = 32;

std::string database_of(const std::string& folder) { return folder + "/world.sqlite"; }

/// Returns when the file was last written, 0 if there is none. SQLite writes edits to the file with
/// the suffix -wal first.
TimeUs changed_us(const std::string& file) {
  struct stat info{};
  if (::stat(file.c_str(), &info) != 0) return 0;
  return info.st_mtim.tv_sec * 1'000'000 + info.st_mtim.tv_nsec / 1'000;
}

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == ' ' ||
         c == '-' || c == '_';
}

}  // namespace

std::string local_worlds_folder() {
  const std::string folder = user_folder(UserFolder::data);
  return folder.empty() ? "" : folder + "/worlds";
}

Result<void, std::string> check_world_name(const std::string& name) {
  if (name.empty()) return failure("the world needs a name");
  if (name.size() > kWorldNameBytesMax)
    return failure("the name of a world has at most 32 characters");
  if (!std::ranges::all_of(name, is_name_character)) {
    return failure(
        "the name of a world has letters from a to z, digits, blanks, hyphens and underscores");
  }
  if (name.front() == ' ' || name.back() == ' ')
    return failure("the name of a world neither begins nor ends with a blank");
  return {};
}

std::vector<LocalWorld> list_local_worlds(const std::string& folder) {
  std::vector<LocalWorld> out;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string(), path = entry->path().string();
    if (!check_world_name(name) || !holds_world(path)) continue;
    const std::string database = database_of(path);
    out.push_back({name, path, std::max(changed_us(database), changed_us(database + "-wal"))});
  }
  std::ranges::sort(out, [](const LocalWorld& a, const LocalWorld& b) {
    return std::tie(b.changed_us, a.name) < std::tie(a.changed_us, b.name);
  });
  return out;
}

bool holds_world(const std::string& folder) {
  std::error_code ignored;
  return std::filesystem::exists(database_of(folder), ignored);
}

}  // namespace runstone
