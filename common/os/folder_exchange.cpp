#include "common/os/folder_exchange.hpp"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

namespace runstone {

Result<void, std::string> exchange_folders(const std::string& a, const std::string& b) {
  if (::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) != 0)
    return failure(std::generic_category().message(errno));
  for (const std::string& folder : {a, b}) {
    const std::string parent = std::filesystem::absolute(folder).parent_path().string();
    const int descriptor = ::open(parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) continue;
    ::fsync(descriptor);  // best effort: some file systems cannot sync a folder
    ::close(descriptor);
  }
  return {};
}

}  // namespace runstone
