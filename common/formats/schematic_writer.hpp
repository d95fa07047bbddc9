// Writes schematics: .schem as WorldEdit and Sponge know it (versions 2 and 3), and .litematic as
// Litematica does (version 6). Both are for Minecraft 1.18.2 and hold blocks only
// (docs/formats.md). Untouched cells are minecraft:structure_void. schematic_names.hpp says how
// materials that Minecraft does not know are written, so that reading gives their names and states
// back.
#pragma once
#include "common/formats/file_writing.hpp"
#include "common/formats/format.hpp"
#include "common/formats/rsb_build.hpp"

namespace runstone {

/// Writes a build as a .schem of version 3. Fails as Format::write does: sides are at most 65,535,
/// and the cells at most 2^31 - 1 and at most as many bytes (two each, if there are more than 128
/// blocks; three each from 16,384 on). The result is deterministic with one version of zlib. Cost:
/// that of walk_cells(), and O(cells). Memory: the runs of 16 layers.
Result<void> write_schem(const FileBuild& file, const FormatSink& sink);

/// Writes a build as a .schem of the chosen version. Both versions hold the same. Otherwise it is
/// as write_schem().
Result<void> write_schem_with(const FileBuild& file, const FileWriting& writing,
                              const FormatSink& sink);

/// Writes a build as a .litematic of one region. Its origin in a world is not kept. Fails as
/// Format::write does: the cells are at most 2^31 - 1. Cost and memory: those of write_schem().
Result<void> write_litematic(const FileBuild& file, const FormatSink& sink);

}  // namespace runstone
