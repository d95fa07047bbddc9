// The seam to the worlds and files of other programs. A reader takes bytes, and gives runs with the
// names and states of their blocks. A writer takes a build, and gives bytes. What lies behind the
// seam does not know which program wrote them.
//   const Format* format = format_of_file("castle.schem");
//   format->read(file, [&](ForeignPiece&& piece) -> Result<void> { ... });
// Neither does I/O. A reader gets one record at a time: a row of a database, a part of a file, or a
// whole file, which the caller may have mapped into memory. It gives one piece at a time, so
// neither the world nor a large file is expanded as a whole.
// Every byte is untrusted: a reader bounds each length, count and nesting that the bytes name, and
// what it decompresses. To add a format, add its reader, its writer, and a row of the table in
// format.cpp (docs/formats.md).
#pragma once
#include <compare>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/material_row.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

struct FileBuild;
struct FileWriting;

/// The look of a block, in formats that give it. A block with alpha below 255 is transparent.
struct ForeignLook {
  MaterialColour colour{0, 0, 0, 255};
  std::optional<MaterialLook> surface = std::nullopt;
  friend auto operator<=>(const ForeignLook&, const ForeignLook&) = default;
};

/// A block of another program. BlockMaterials (block_materials.hpp) makes materials of blocks.
struct ForeignBlock {
  std::string name;    // such as "default:stone"; any bytes
  std::string states;  // such as "facing=north,half=bottom", ascending by key; empty: none
  std::optional<ForeignLook> look = std::nullopt;  // in formats of colours, such as .vox
  friend auto operator<=>(const ForeignBlock&, const ForeignBlock&) = default;
};

/// The voxels of a box, which a reader cuts so that each piece is a valid RunChunk: no side is longer
/// than kSideMax. The axes are those of a world: x east, y up, z south. A reader turns the axes of a
/// format whose z is up.
struct ForeignPiece {
  VoxelPos origin;  // of the voxel with the lowest coordinates, from the place of the record
  // In any axis order. Material i + 1 is blocks[i]. Material 0 is a voxel of which the record says
  // nothing. A block of air is a block.
  RunChunk voxels;
  std::vector<ForeignBlock> blocks;  // may have blocks that do not occur
};

/// The information that a file has about its contents. It is not verified.
struct ForeignInfo {
  std::string name, author;  // any bytes; empty: the file does not say
  TimeUs created_us = 0;     // UTC, microseconds since 1970; 0: the file does not say
  VoxelPos origin;           // of the place in a world that is at (0, 0, 0) in the pieces
  friend bool operator==(const ForeignInfo&, const ForeignInfo&) = default;
};

using PieceSink = std::function<Result<void>(ForeignPiece&&)>;
/// Takes the next bytes of a file. Returns false if they cannot be written, which ends the writing.
using FormatSink = std::function<bool(ByteView)>;

/// The further properties of a format of triangles. Its functions that write fail with bad_value,
/// before anything is written, if the build shows no face.
struct TriangleFormat {
  /// A second file holds the materials: its name has this ending instead of that of the format, and
  /// ModelWriting::material_file names it in the first file. Empty: there is none.
  std::string_view companion_ending = {};
  Result<void> (*write_companion)(const FileBuild& build, const FormatSink& sink) = nullptr;
  /// True: a file holds its levels of detail. False: they are files of their own, level_file().
  bool holds_levels = false;
};

struct Format {
  std::string_view name;         // of the program or of the format
  std::string_view file_ending;  // the path of a file of this format ends so
  /// Gives the pieces of one record to the sink, in any order. If pieces overlap, the later one counts
  /// where it says something. Fails if the bytes are bad, and then the error names the field and the
  /// rule, and its offset is a byte of the record, or of what the record decompresses to. Fails with
  /// the error of the sink if the sink fails. Pieces that the sink got before are sound. Null: the
  /// format is only written.
  Result<ForeignInfo> (*read)(ByteView record, const PieceSink& sink);
  /// Returns the material that a block becomes. The result is deterministic, and
  /// MaterialTable::add() accepts it for every block, if the name is not taken. `keep_all`: blocks
  /// that are no whole cube and have no shape are not empty.
  MaterialInfo (*material_of)(const ForeignBlock& block, bool keep_all);
  /// Writes a build as one file. Fails with limit_exceeded and the limit in the text if the build is
  /// larger, or has more materials, than a file of this format holds; nothing was written then. Fails
  /// with io_failed if the sink returns false. Null: the format is only read.
  Result<void> (*write)(const FileBuild& build, const FormatSink& sink) = nullptr;
  /// True: a record is a whole file. False: a record is a part of a world, such as a row of a database.
  bool is_file = true;
  /// Writes a build as `write` does, with the choices that concern this format. `write` takes the
  /// default choices. Null: the format has no choices.
  Result<void> (*write_with)(const FileBuild& build, const FileWriting& writing,
                             const FormatSink& sink) = nullptr;
  /// The further properties if the format has triangles, otherwise null. Such formats are only
  /// written.
  const TriangleFormat* model = nullptr;
};

std::span<const Format> formats();
/// Returns true if a path has an ending. Upper and lower case are equal.
bool has_ending(std::string_view path, std::string_view ending);
/// Returns the format by the ending of a path, upper and lower case being equal, or null if no format
/// has it.
const Format* format_of_file(std::string_view path);

}  // namespace runstone
