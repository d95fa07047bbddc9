// Exchanges two folders.
#pragma once
#include <string>

#include "common/core/result.hpp"

namespace runstone {

/// Gives each of two folders the name of the other one, in one step: whatever interrupts the
/// program, both names have a whole folder. The change is on disk on return. Fails if the folders
/// are on different file systems, or if the file system cannot exchange names. The error is the
/// system's message.
Result<void, std::string> exchange_folders(const std::string& a, const std::string& b);

}  // namespace runstone
