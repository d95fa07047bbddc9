// Reads schematics: the files of WorldEdit and Sponge (.schem, versions 1 to 3), and those of MCEdit,
// Schematica and WorldEdit before 1.13 (.schematic, blocks as numbers). The content tells which of the
// two a file is, because both occur with both endings. Entities, contents of blocks such as chests, and
// biomes are not kept (docs/formats.md).
#pragma once
#include "common/formats/format.hpp"

namespace runstone {

/// Reads a whole file. Cells of minecraft:structure_void are those of which the file says nothing. The
/// pieces are 64 a side, from the lowest corner of the schematic on; the origin is the place from which
/// WorldEdit copied it. Fails as Format::read does. Memory: some MB, at most 24 MiB of names, and the
/// runs of 64 layers. Cost: the file is inflated twice, that of MCEdit up to four times.
Result<ForeignInfo> read_schematic(ByteView file, const PieceSink& sink);

}  // namespace runstone
