#include "common/os/folder_entries.hpp"

#include <algorithm>
#include <system_error>

namespace runstone {

Result<std::vector<std::filesystem::path>, std::string> folder_entries(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  const std::filesystem::directory_iterator end;
  // The operator ++ of the iterator throws, increment() does not.
  for (std::filesystem::directory_iterator entry(folder, error); !error && entry != end;
       entry.increment(error))
    paths.push_back(entry->path());
  if (error) return failure(folder + ": cannot be read: " + error.message());
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace runstone
