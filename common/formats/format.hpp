// The seam to the worlds and files of other programs: a reader takes bytes, and gives runs with the
// names and states of their blocks. What lies behind the seam does not know which program wrote
// them.
//   const Format* format = format_of_file("valley/map.sqlite");
//   format->read(record, [&](ForeignPiece&& piece) -> Result<void> { ... });
// A reader does no I/O. It gets one record at a time: a row of a database, a part of a file, or a
// whole file, which the caller may have mapped into memory. It gives one piece at a time, so
// neither the world nor a large file is in memory as a whole.
// Every byte is untrusted: a reader bounds each length, count and nesting that the bytes name, and
// what it decompresses. To add a format, add its reader and a row of the table in format.cpp.
#pragma once
#include <compare>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// A block of another program. BlockMaterials (block_materials.hpp) makes materials of blocks.
struct ForeignBlock {
  std::string name;    // such as "default:stone"; any bytes
  std::string states;  // such as "facing=north,half=bottom", ascending by key; empty: none
  friend auto operator<=>(const ForeignBlock&, const ForeignBlock&) = default;
};

/// The voxels of a box, which a reader cuts so that each piece is a valid RunChunk.
struct ForeignPiece {
  VoxelPos origin;  // of the voxel with the lowest coordinates, from the place of the record
  // In AxisOrder::xyz. Material i + 1 is blocks[i]. Material 0 is a voxel of which the record says
  // nothing.
  RunChunk voxels;
  std::vector<ForeignBlock> blocks;  // may have blocks that do not occur
};

using PieceSink = std::function<Result<void>(ForeignPiece&&)>;

struct Format {
  std::string_view name;         // of the program or of the format
  std::string_view file_ending;  // the path of a file of this format ends so
  /// Gives the pieces of one record to the sink, in any order. Fails if the bytes are bad, and then
  /// the error names the field and the rule, and its offset is a byte of the record, or of what the
  /// record decompresses to. Fails with the error of the sink if the sink fails. Pieces that the
  /// sink got before are sound.
  Result<void> (*read)(ByteView record, const PieceSink& sink);
  /// Returns the material that a block becomes. The result is deterministic, and
  /// MaterialTable::add() accepts it for every block, if the name is not taken. `keep_all`: blocks
  /// that are no whole cube, such as plants, are not empty.
  MaterialInfo (*material_of)(const ForeignBlock& block, bool keep_all);
};

std::span<const Format> formats();
/// Returns the format by the ending of a path, or null if no format has it.
const Format* format_of_file(std::string_view path);

}  // namespace runstone
