// A file, cut into blocks of kBlockBytes.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "server/backup/backup_manifest.hpp"

namespace runstone {

/// Gets the bytes of a block, and returns their hash.
using TakeBlock = std::function<Result<BlockHash, std::string>(ByteView)>;

/// Passes the blocks of a file to `take`, in order, and returns the file with their hashes. Fails
/// if the file cannot be read, or with the error of `take`.
Result<BackedUpFile, std::string> cut_file(const std::filesystem::path& path,
                                           const TakeBlock& take);

/// Returns the files of a copied world, in the order of their names. Leaves out the lock of a
/// folder of unfinished files (NewFolder).
Result<std::vector<std::filesystem::path>, std::string> files_of_copy(const std::string& folder);

}  // namespace runstone
