// Reads the schematics of Litematica (.litematic, versions 1 to 7): any number of regions, each with a
// palette and an array of packed numbers. Entities, contents of blocks and scheduled ticks are not kept
// (docs/formats.md).
#pragma once
#include "common/formats/format.hpp"

namespace runstone {

/// Reads a whole file. Cells of minecraft:structure_void are those of which the file says nothing. The
/// pieces are 64 a side, from the lowest corner of each region on, and lie where the regions lie from
/// the origin of the schematic. Fails as Format::read does. Memory: some MB, at most 24 MiB of names,
/// and the runs of 64 layers. Cost: the file is inflated twice.
Result<ForeignInfo> read_litematic(ByteView file, const PieceSink& sink);

}  // namespace runstone
