// BackupManifest: what one backup of a backup folder is made of: the files of a world, each as a
// list of blocks. docs/server-reference.md, "The backup folder", describes its text.
// Threads: any. The functions read no clock and no file.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "server/store/world_info.hpp"

namespace runstone {

/// BLAKE2b of the bytes of a block, 256 bits.
using BlockHash = std::array<std::uint8_t, 32>;
/// The bytes of each block of a file but the last one, which may be shorter. A block is written
/// anew if one of its bytes has changed; smaller blocks would be more files.
inline constexpr std::size_t kBlockBytes = std::size_t{32} << 10;

BlockHash hash_of_block(ByteView bytes);

struct BackedUpFile {
  std::string name;  // without a folder
  std::uint64_t bytes = 0;
  std::vector<BlockHash> blocks;  // in the order of the file
  friend bool operator==(const BackedUpFile&, const BackedUpFile&) = default;
};

struct BackupManifest {
  WorldId world{};
  TimeUs taken_us = 0;  // UTC, when the backup began; whole seconds
  Epoch epoch = 0;      // of the moment of the source
  Sequence seq = 0;
  std::uint64_t new_bytes = 0;  // of the blocks that no earlier backup had
  std::vector<BackedUpFile> files;

  /// Returns the bytes of all files.
  std::uint64_t bytes() const;
  friend bool operator==(const BackupManifest&, const BackupManifest&) = default;
};

/// Returns the text of a manifest. It ends with a hash of all of it.
std::string manifest_text(const BackupManifest& manifest);
/// Parses the text of a manifest. Fails if a byte of it has changed or is missing, or if the text
/// is of a newer version. The error is a part of a sentence.
Result<BackupManifest, std::string> parse_manifest(std::string_view text);

/// Parses the lines of a manifest that are above its first file. `text` may end behind them.
/// Returns nullopt if they are no such lines. The hash at the end is not looked at.
std::optional<BackupManifest> parse_manifest_head(std::string_view text);
/// Reads a manifest as parse_manifest() does, but its files get no blocks, so it needs no memory
/// for them.
Result<BackupManifest, std::string> read_manifest_sizes(std::istream& in);

/// Returns the name of a backup, such as "20261118T033000Z". The time is rounded down to the
/// second.
std::string backup_name(TimeUs taken_us);
/// Returns the time of such a name, or nullopt if the text is no name of a backup.
std::optional<TimeUs> time_of_backup(std::string_view name);

}  // namespace runstone
