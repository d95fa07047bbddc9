// The voxels of a foreign file cell by cell: what a test compares. Each piece is checked.
#pragma once
#include <map>
#include <string>

#include "common/formats/format.hpp"

namespace runstone::test {

struct ForeignCells {
  ForeignInfo info;
  std::map<VoxelPos, std::string> blocks;  // "name" or "name[states]"; cells that are touched only
  VoxelBox box;                            // around the pieces
  std::size_t pieces = 0;
};

/// Reads a file with a reader of a format. Fails an assertion if a piece breaks a rule of the seam.
/// Cells of pieces with more than 2^20 voxels in all are not kept, only their box.
Result<ForeignCells> read_foreign_cells(Result<ForeignInfo> (*read)(ByteView record,
                                                                    const PieceSink& sink),
                                        ByteView file);

}  // namespace runstone::test
