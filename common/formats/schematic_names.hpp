// Names and states of blocks in the files of Minecraft's tools, and how materials of any name and
// states are written there, so that reading gives the same back.
//
// A name that the game allows, "namespace:path", is written as it is. Any other name, such as "red
// bricks", becomes "runstone:red_bricks": a blank is "_", and each byte other than a-z, 0-9, "-" and
// "/" is "." with two hexadecimal digits. So is a name that the states would change: materials of
// Minecraft's blocks have names with their states, and those of other games have not. Reading leaves
// such a name as it is, and material_of_schematic_block() finds the material's name in it.
// States of the form "key=value,key=value" that ascend by key are written as they are. Others become one
// state with the key "runstone", in which each byte other than a-z and 0-9 is "_" with two digits.
// Untouched cells are minecraft:structure_void, so a material of that name has a name by the rule.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/formats/build_head.hpp"
#include "common/formats/format.hpp"

namespace runstone {

inline constexpr std::string_view kUntouchedBlock = "minecraft:structure_void";
/// Files are written for this version of the game, which is 1.18.2.
inline constexpr std::int32_t kSchematicDataVersion = 2975;

using BlockProperty = std::pair<std::string, std::string>;  // key and value

/// Returns true if a name of a file, with or without "[states]", stands for untouched cells.
bool is_untouched_in_schematic(std::string_view text);
/// Returns the block with this name in a file. A name without a namespace is one of "minecraft".
ForeignBlock block_of_schematic(std::string_view name, std::vector<BlockProperty> properties);
/// Returns the block of a text such as "minecraft:oak_stairs[facing=north,half=bottom]".
ForeignBlock block_of_schematic_text(std::string_view text);

/// Returns the material that a block of a schematic becomes. A name that schematic_block_of() made is the
/// material's own again; `keep_all` does not concern it. Other blocks are those of Minecraft.
MaterialInfo material_of_schematic_block(const ForeignBlock& block, bool keep_all);

/// Returns the block as which a material is written. Its name and its states are valid in the game's
/// files. A material of an imported world, whose name holds states (minecraft_blocks.hpp), becomes the
/// block with these states. A block of Minecraft without states gets its default ones, because other
/// programs expect all of them.
ForeignBlock schematic_block_of(const BuildMaterial& material);
/// Returns the states of schematic_block_of() as pairs.
std::vector<BlockProperty> properties_of(std::string_view states);
/// Returns "name[states]", or the name if there are no states.
std::string schematic_text_of(const ForeignBlock& block);

}  // namespace runstone
