// Builds as files of any format, chosen by the ending of the file's name: .rsb, and the formats of
// the table in format.cpp that are whole files.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/formats/build_of_file.hpp"
#include "common/formats/file_writing.hpp"
#include "common/formats/format.hpp"
#include "common/formats/rsb_build.hpp"

namespace runstone {

/// Reads the bytes of a file as a build. The error is one line with the file, the place and the
/// reason. Fails if `reading` has colours and the file is no height map.
Result<FileBuild, std::string> read_file_build(const std::string& file, ByteView bytes,
                                               const ForeignReading& reading);

/// Writes a build in the format of the file's ending. An .obj names companion_file(file), whatever
/// `writing` names. Fails as choice_refusal() says. The error is one line with the file and the
/// reason; it is "cannot be written" if the sink returned false.
Result<void, std::string> write_file_build(const std::string& file, const FileBuild& build,
                                           const FormatSink& sink, FileWriting writing = {});

/// Returns why a file of this name cannot be written with these choices, or an empty text: a
/// version of the .schem is chosen, and the file is none. Choices for models count for models only.
std::string choice_refusal(std::string_view file, const FileWriting& writing);

/// Returns the path of the second file that belongs to a file of this name, such as castle.mtl to
/// castle.obj, or an empty text. A caller of write_file_build() writes it with write_companion(),
/// before the first file, because that names it.
std::string companion_file(const std::string& file);
/// Writes the second file. `file` is the name of the first one, and companion_file() is not empty.
/// The error is one line with the second file and the reason.
Result<void, std::string> write_companion(const std::string& file, const FileBuild& build,
                                          const FormatSink& sink);

/// Returns true if the levels of detail of a model in a file of this name are files of their own.
bool has_level_files(const std::string& file);
/// Returns the path of such a file, such as castle.lod2.obj to castle.obj.
std::string level_file(const std::string& file, unsigned level);

/// Returns the number of cells whose material is not empty. Cost: O(sections + runs).
std::uint64_t solid_cells(const FileBuild& build);

/// Returns why a file of this name can be neither read (or written, with `is_written`), as a
/// sentence with the endings that can be, or an empty text.
std::string ending_refusal(std::string_view file, bool is_written);

}  // namespace runstone
