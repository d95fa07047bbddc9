// BuildFolder: the .rsb files of a folder of the server's machine, and reading them one batch after
// another. Threads: a worker makes and reads it; it does not change afterwards.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "server/admin/build_file.hpp"
#include "server/rollback/should_continue.hpp"

namespace runstone {

struct BuildFolder {
  std::string path;
  std::vector<std::string> names;  // of its .rsb files, ascending by their bytes
  std::size_t others = 0;          // files of other kinds and folders in it
  /// The digest and the length of each file that the library had when the folder was listed,
  /// ascending.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> known;
};

/// Lists a folder, without the folders in it, and the files of the library. The error is one line.
/// Fails if the folder has more than `files_max` names that end with .rsb, in upper or lower case.
/// Blocks on the disk. Cost: O(files of the folder and builds of the library), without reading
/// files.
Result<BuildFolder, std::string> list_build_folder(LibraryReader& library, const std::string& path,
                                                   std::uint64_t files_max,
                                                   const ShouldContinue& should_continue);

/// A batch ends at so many files, and at the file with which it has so many bytes.
inline constexpr std::size_t kFolderBatchFiles = 256, kFolderBatchBytes = std::size_t{4} << 20;

/// Files of a folder that were read.
struct FolderBatch {
  std::vector<BuildFile> builds;
  std::vector<std::string> refusals;  // one line each, with the name of the file
  std::uint64_t known = 0;            // files that the library had already
  std::size_t next = 0;               // the first name that was not read
};

/// Reads and verifies files of the folder from the name `first` on. A file may have `bytes_max`
/// bytes. Ends early if `should_continue` returns false. Blocks on the disk. Memory: the batch, and
/// one file.
FolderBatch read_build_folder(const BuildFolder& folder, std::size_t first, std::uint64_t bytes_max,
                              const ShouldContinue& should_continue);

}  // namespace runstone
