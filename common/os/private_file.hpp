// Private files: settings, lists and keys of one user, which other users of the machine may not
// read.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Replaces `file` by one with these bytes, mode 0600, and makes the folders above it, mode 0700.
/// If `file` is a symbolic link, the file to which it leads is replaced, and the link stays. After
/// a crash the old file or the new one is there, complete. It is on disk on return. Fails with a
/// line that begins with the name of the file. Waits for the disk.
Result<void, std::string> write_private_file(const std::string& file, std::string_view bytes);

/// Makes a folder and those above it, mode 0700. A folder that exists keeps its mode. Returns false
/// with errno if that fails.
bool make_private_folder(const std::string& folder);

/// Files of settings, certificates, keys and the like have at most so many bytes.
inline constexpr std::size_t kSmallFileBytesMax = std::size_t{1} << 20;

/// What may stand behind the name of a file that is read as a whole.
enum class FileKinds : std::uint8_t {
  regular,         // for a server that runs: a device could have no end, and a pipe would block
  regular_or_pipe  // for options of a program, such as `--password-file <(pass show world)`
};

/// Returns the bytes of a small file that settings, options and commands name. Fails with a line
/// that begins with the name of the file if it cannot be read, is of another kind, or has more than
/// `bytes_max` bytes. Waits for the other end of a pipe.
Result<std::string, std::string> read_file(const std::string& file, std::size_t bytes_max,
                                           FileKinds kinds = FileKinds::regular);
/// Returns the bytes of a file of any size, as read_file() does. Memory: the file, once.
Result<Bytes, std::string> read_file_bytes(const std::string& file, std::size_t bytes_max,
                                           FileKinds kinds = FileKinds::regular);

/// Fails with a line that begins with the name of the file if there is none, or one of another kind.
/// For readers that open the file themselves: this call opens nothing, so it never waits for the
/// other end of a pipe.
Result<void, std::string> check_file_kind(const std::string& file,
                                          FileKinds kinds = FileKinds::regular);

/// Renames a file that cannot be used to `file` + ".broken", so that its user can repair it.
/// Replaces an older broken file. Returns the new name, or an empty text if that failed.
std::string set_aside(const std::string& file);

}  // namespace runstone
