// Reads the names in a folder.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "common/core/result.hpp"

namespace runstone {

/// Returns the paths of all that is in a folder, in the order of their names. Fails if the folder
/// cannot be read to its end. The error is one line that begins with the name of the folder. Unlike
/// a range `for` over std::filesystem::directory_iterator, a fault of the disk throws nothing.
Result<std::vector<std::filesystem::path>, std::string> folder_entries(const std::string& folder);

}  // namespace runstone
