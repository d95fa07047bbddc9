// Builds in files of the disk, in any format (docs/formats.md): the one way in which programs read
// and write them. Thread: any. Calls block on the disk.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "common/build_files/model_reading.hpp"
#include "common/core/result.hpp"
#include "common/formats/file_build.hpp"

namespace runstone {

/// The maximum size of a file with a build that a player or a command names.
inline constexpr std::size_t kBuildFileBytesMax = std::size_t{256} << 20;

/// How a file becomes a build.
struct BuildReading {
  ForeignReading foreign;
  ModelReading model;  // of files of triangles or points
  ReadNotice notice;   // may be empty
};

/// Returns why a file of this name can be neither read (or written, with `is_written`), as a sentence
/// with the endings that can be, or an empty text.
std::string file_refusal(const std::string& file, bool is_written);

/// Reads a file with a build, whose ending names the format, or a model (is_model_file()). If `reading`
/// has no name, a build without a name gets that of the file without its ending. The error is one line
/// that begins with the name of the file. Fails if the file has more than `file_bytes_max` bytes (of a
/// model the limits of ModelReading hold), and if it is a pipe or a device, because reading it may never
/// end. Memory: the file and the build.
Result<FileBuild, std::string> read_build_of_file(const std::string& file,
                                                  BuildReading reading = {},
                                                  std::size_t file_bytes_max = kBuildFileBytesMax);

/// Writes a build in the format of the file's ending, as open_output_file() does: an old file is
/// replaced when the new one is whole. Fails if choice_refusal() refuses. The materials of an .obj
/// become a second file, companion_file(). Levels of detail of an .obj or .ply become files of
/// their own, level_file(); a single voxel has no coarser level, nor have shapes of which none is a
/// cube (visibility_as_cube()). Returns the number of bytes of all files. The error is one line
/// that begins with the name of the file.
Result<std::uint64_t, std::string> write_build_to_file(const std::string& file,
                                                       const FileBuild& build,
                                                       const FileWriting& writing = {});

/// Returns the name of a build that is written to a file and has no other name: that of the file
/// without its ending, or "build" if no build may have that name.
std::string build_name_of_file(const std::string& file);

}  // namespace runstone
