// Luanti schematics .mts: in and out. A schematic is a box of nodes with probabilities. Format: Luanti's
// comments in src/mapgen/mg_schematic.h, versions 1 to 4. Axes are taken as
// they are, as those of Luanti's worlds are (luanti_block.hpp).
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/formats/format.hpp"
#include "common/formats/rsb_build.hpp"

namespace runstone {

/// The longest side of a schematic.
inline constexpr std::int32_t kMtsSideMax = 65'535;
inline constexpr std::size_t kMtsNameBytesMax = std::size_t{32} << 20;

/// Reads an .mts. Nodes and layers that are never placed, and "ignore", are untouched. Nodes that are
/// placed by chance are placed; their chance is not kept. The param2 of a node is the state "param2=N",
/// if it is not 0. A name such as "a:b[c=d]" of write_mts() is a name with states. The offset of an
/// error is a byte of the file. Cost: O(nodes). Memory: the runs of 64 layers, the names and 1 MiB.
Result<ForeignInfo> read_mts(ByteView file, const PieceSink& sink);

/// Writes an .mts of version 4. Untouched cells are never placed, and the others always. States
/// "param2=N" become the param2, and so does "[param2=N]" at the end of the name of a material
/// without states; other states stand behind the name, in brackets. Names with blanks and other
/// than ASCII characters are written as luanti_node_name() says. Fails with limit_exceeded if a
/// side is longer than kMtsSideMax, or if there are more than 65,535 names. Cost: O(cells).
Result<void> write_mts(const FileBuild& build, const FormatSink& sink);

}  // namespace runstone
