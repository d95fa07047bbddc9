// Private files: settings, lists and keys of one user, which other users of the machine may not
// read.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include "common/core/result.hpp"

namespace runstone {

/// Replaces `file` by one with these bytes, mode 0600, and makes the folders above it, mode 0700.
/// After a crash the old file or the new one is there, complete. It is on disk on return. Fails
/// with a line that begins with the name of the file. Waits for the disk.
Result<void, std::string> write_private_file(const std::string& file, std::string_view bytes);

/// Makes a folder and those above it, mode 0700. A folder that exists keeps its mode. Returns false
/// with errno if that fails.
bool make_private_folder(const std::string& folder);

/// Files of settings, certificates, keys and the like have at most so many bytes.
inline constexpr std::size_t kSmallFileBytesMax = std::size_t{1} << 20;

/// Returns the bytes of a regular file. It is for every small file that settings, options and
/// commands name: a device could have no end, and a pipe would block. Fails with a line that begins
/// with the name of the file if it cannot be read, is no regular file, or has more than `bytes_max`
/// bytes.
Result<std::string, std::string> read_file(const std::string& file, std::size_t bytes_max);

/// Renames a file that cannot be used to `file` + ".broken", so that its user can repair it.
/// Replaces an older broken file. Returns the new name, or an empty text if that failed.
std::string set_aside(const std::string& file);

}  // namespace runstone
