// The states of Minecraft's blocks: which keys a block has, the values of each, and the one that a
// block has by default. They are rules on the ends of names, with exceptions by name, so the rules
// also hold for most blocks of modifications ("biome:fir_stairs"). Internal to the facts of
// Minecraft's blocks (minecraft_blocks.hpp).
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace runstone {

/// Returns true if `names` has the name. They are separated by blanks; '*' stands for any text.
bool rule_names(std::string_view names, std::string_view name);

/// The key of a state and its values, such as "half=bottom|top". The first value is the default.
using MinecraftProperty = std::string_view;

/// Returns the properties of a block, ascending by key, or none if no rule knows the block. `name`
/// is the name behind the namespace. Cost: O(rules).
std::vector<MinecraftProperty> minecraft_properties(std::string_view name);

/// Returns the parts of a property. value_of() requires index < value_count().
std::string_view key_of(MinecraftProperty property);
std::size_t value_count(MinecraftProperty property);
std::string_view value_of(MinecraftProperty property, std::size_t index);
/// Returns the index of a value, or nullopt if the property does not have it.
std::optional<std::size_t> index_of_value(MinecraftProperty property, std::string_view value);

/// States by key, ascending. The views point into the text that was split.
using StateList = std::vector<std::pair<std::string_view, std::string_view>>;
/// Splits "facing=north,half=top". Returns nullopt unless each part is KEY=VALUE, of the characters
/// a-z, 0-9 and '_', and the keys ascend strictly. Empty text has no states.
std::optional<StateList> split_states(std::string_view states);
std::string join_states(const StateList& states);

}  // namespace runstone
