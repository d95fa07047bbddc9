// The file of the command `builds import`, and the texts about builds of the library.
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/edits/descriptor/library_change.hpp"
#include "common/formats/rsb_build.hpp"
#include "server/store/library_reader.hpp"

namespace runstone {

/// A file that was read as a whole, and the change that adds it. Its content number is not drawn yet.
struct BuildFile {
  AddBuild build;
  std::shared_ptr<const Bytes> bytes;
};

/// The cost of a section for verify_build(), in runs.
inline constexpr std::uint64_t kRunsOfSection = 16;
/// Verifies all bytes of the file of a build, and returns the change that adds it. Its content number
/// is not drawn yet. The error is one line. Fails also if the runs of all sections, and kRunsOfSection
/// more for each section, are more than `runs_max`, because a small file can unpack to any number of
/// them, and if `should_continue`, which is called for each section, returns false. Cost: O(runs).
Result<AddBuild, std::string> verify_build(
    ByteView file, std::uint64_t runs_max = std::numeric_limits<std::uint64_t>::max(),
    const std::function<bool()>& should_continue = {});

/// Reads the file of a build and verifies all of it. The error is one line that begins with the name
/// of the file. Fails if the file has more than `bytes_max` bytes, and if it is a pipe or a device,
/// because reading it may never end. Blocks on the disk.
Result<BuildFile, std::string> read_build_file(const std::string& file, std::uint64_t bytes_max);

/// Writes the file of a build as open_output_file() does, part by part. The error is one line. Blocks
/// on the disk.
Result<void, std::string> write_build_file(LibraryReader& reader, const StoredBuild& build,
                                           const std::string& file);

/// Reads a build of the library. The error is one line. Blocks on the disk.
Result<FileBuild, std::string> read_stored_build(LibraryReader& reader, const StoredBuild& build);

/// Draws a build from above (build_picture()), and writes the picture to a PNG file. The error is one
/// line. Blocks on the disk.
Result<void, std::string> write_build_picture(LibraryReader& reader, const StoredBuild& build,
                                              const std::string& file);

/// Returns a line such as `120 "Mill" by Ada, 70 x 30 x 20, 12 KiB, mill wood`.
std::string build_line(Sequence number, const AddBuild& build);
/// Returns lines with everything that the library knows of a build. `added_by`: the name of the
/// player who added it, or "the console".
std::string build_text(const StoredBuild& build, const std::string& added_by);
/// Returns text about a change, for the command `log`.
std::string library_change_text(const LibraryChange& change);

}  // namespace runstone
