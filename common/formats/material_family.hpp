// Families: the materials of a table that are one block in different states, such as the stairs of
// oak. Materials belong to one family if their names are equal up to the states; no table records
// it.
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "common/core/ids.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// A name of a material, taken apart.
struct MaterialStates {
  std::string family;  // "minecraft:oak_stairs"
  /// By key, also those that have their default: {"facing", "north"}. A material that no rule knows
  /// has the states that its name writes.
  std::map<std::string, std::string, std::less<>> states;

  /// Returns the part of the family behind its namespace.
  std::string_view path() const { return std::string_view(family).substr(family.find(':') + 1); }
  /// Returns the value of a key, or an empty text if it is missing.
  std::string_view get(std::string_view key) const;
  bool has(std::string_view key) const { return states.find(key) != states.end(); }
};

/// Returns true if Luanti's rules for the shapes of nodes know the name: its states are a param2.
bool is_shaped_node(std::string_view material);

/// Returns the family and the states of a name. Cost: O(rules + bytes).
MaterialStates states_of_material(std::string_view name);

/// Returns the member of the family that differs in the fewest states; of equal ones the one with
/// the lowest id. The values of walls before 1.16 (true, false) count as those of today (low,
/// none). Returns nullopt if the table has no member, or only empty ones. Cost: O(rules + log
/// table) if a member has exactly these states, otherwise that for each member.
std::optional<Material> nearest_member(const MaterialTable& table, const MaterialStates& wanted);

}  // namespace runstone
