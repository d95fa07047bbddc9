// Facts about the blocks of Minecraft Java: the names of the numbers that worlds had before 1.13,
// the names of materials that keep a block's states, and what each block looks like. The colours
// were chosen by hand for this project or are composed by rule; no art of the game is used.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/formats/format.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns the block that the number of a block of 1.12 and its data stand for, with its name of
/// today and all its states. States that 1.12 computed from the neighbours, such as the sides of a
/// fence, and those that it kept elsewhere, such as the colour of a bed, have their defaults. Data
/// that 1.12 does not use counts as 0. Returns nullopt for an unknown id, or if data is above 15.
/// Cost: O(rows).
std::optional<ForeignBlock> minecraft_block_of(std::uint16_t id, std::uint8_t data);

/// Returns the block with each state that it lacks at its default, as the game reads it, and with
/// the namespace "minecraft" if it names none. Blocks of other namespaces keep their states. A block
/// whose states are not well formed is returned unchanged.
ForeignBlock with_default_states(const ForeignBlock& block);

/// Returns the name of the material that a block becomes: 1 .. 64 bytes of ASCII without blanks. It
/// has the first of these forms that fits:
///   - "minecraft:oak_stairs[facing=east,half=top]": the states that are not the default. Without
///     any, the brackets are left out. A missing state and one at its default are the same to the
///     game, so both get this name.
///   - "mod:fir_stairs{facing=east}": exactly these states, for blocks of other namespaces whose
///     keys are not those that the rule for the name expects.
///   - "minecraft:redstone_wire~21f10": one digit (0-9, a-z) for each property of the rule,
///     ascending by key: the index of the value.
///   - "mod:long_na#0123456789abcdef": the beginning of the name, and the hash of name and states.
///     It is for unknown blocks that fit no other form, and for names or states with characters that
///     the game does not allow. This form alone is not reversible.
/// Blocks that differ in name or states get different names, but for 64-bit hashes that collide. All
/// kinds of air are "air".
std::string minecraft_material_name(const ForeignBlock& block);

/// Returns the block that a material was made of: the inverse of minecraft_material_name(), after
/// with_default_states(). "air" is "minecraft:air". Returns nullopt for any other name that has no
/// namespace, that has the form with a hash, or that no block becomes.
std::optional<ForeignBlock> block_of_minecraft_material(std::string_view name);

/// Returns the material that a block becomes: the name of minecraft_material_name(), and colour,
/// visibility, body, look and shape by name and states. The kinds of air and structure_void are
/// empty. Plants, torches and the like are passable. Unless keep_all, those that stand in water
/// become water, and those without a shape are empty. Water, glass and ice are transparent. Other
/// names get a colour from the words in them, and otherwise from their hash. The result is
/// deterministic, and MaterialTable::add() accepts it for every block. Cost: O(table + bytes).
MaterialInfo material_of_minecraft_block(const ForeignBlock& block, bool keep_all);

}  // namespace runstone
