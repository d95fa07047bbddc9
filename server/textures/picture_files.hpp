// PictureFiles: the files with some ending below a folder of the server's machine, by name. Links
// are not followed. Thread: any. Blocks on the disk.
#pragma once
#include <cstddef>
#include <map>
#include <string>

#include "common/core/result.hpp"

namespace runstone {

/// The files and folders below a folder that are looked at.
inline constexpr std::size_t kPictureFilesMax = 100'000;
inline constexpr int kPictureFoldersDeep = 16;

/// The path of each file by its path below the folder, with '/' between the names.
using FilesBelow = std::map<std::string, std::string>;

/// Returns the files below `folder` whose name ends with `ending`, such as ".png". The error is one
/// line: the folder cannot be read, or has more than kPictureFilesMax entries.
Result<FilesBelow, std::string> files_below(const std::string& folder, const std::string& ending);

/// Returns the name of a file without its folders and its ending.
std::string stem_of(const std::string& path);

}  // namespace runstone
