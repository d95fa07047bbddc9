#include "server/textures/picture_files.hpp"

#include <filesystem>
#include <system_error>

namespace runstone {

namespace {

namespace fs = std::filesystem;

}  // namespace

Result<FilesBelow, std::string> files_below(const std::string& folder, const std::string& ending) {
  FilesBelow found;
  std::error_code error;
  fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, error);
  std::size_t seen = 0;
  for (; !error && at != fs::recursive_directory_iterator(); at.increment(error)) {
    if (++seen > kPictureFilesMax)
      return failure(folder + ": has more than " + std::to_string(kPictureFilesMax) +
                     " files and folders");
    std::error_code kind_error;
    if (at->is_symlink(kind_error) || at.depth() >= kPictureFoldersDeep) {
      at.disable_recursion_pending();
      continue;
    }
    const std::string path = at->path().string();
    if (path.ends_with(ending) && at->is_regular_file(kind_error))
      found.emplace(at->path().lexically_relative(folder).generic_string(), path);
  }
  if (error) return failure(folder + ": " + error.message());
  return found;
}

std::string stem_of(const std::string& path) { return fs::path(path).stem().string(); }

}  // namespace runstone
