#include "common/formats/material_family.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "common/core/coords.hpp"
#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/minecraft_states.hpp"
#include "common/formats/shape_names.hpp"
#include "common/shapes/shape_states.hpp"

namespace runstone {
namespace {

std::string_view today(std::string_view value) {
  return value == "true" ? "low" : value == "false" ? "none" : value;
}

/// Returns the number of keys whose values differ. A missing one differs from every value.
std::size_t difference(const MaterialStates& a, const MaterialStates& b) {
  std::size_t out = 0;
  for (const auto& [key, value] : a.states)
    out += b.has(key) && today(b.get(key)) == today(value) ? 0 : 1;
  for (const auto& [key, value] : b.states) out += a.has(key) ? 0 : 1;
  return out;
}

std::string written(const MaterialStates& states) {
  std::string out;
  for (const auto& [key, value] : states.states)
    out.append(out.empty() ? "" : ",").append(key).append("=").append(value);
  return out;
}

}  // namespace

std::string_view MaterialStates::get(std::string_view key) const {
  const auto found = states.find(key);
  return found == states.end() ? std::string_view() : std::string_view(found->second);
}

bool is_shaped_node(std::string_view material) {
  return turned_node_name(material, {Axis::x, Axis::y, Axis::z}, 0).has_value();
}

MaterialStates states_of_material(std::string_view name) {
  MaterialStates out;
  const bool is_node = is_shaped_node(name);
  const auto block = is_node ? std::nullopt : block_of_minecraft_material(name);
  out.family = block ? block->name : std::string(name.substr(0, name.find('[')));
  if (is_node) out.states.emplace("param2", "0");
  if (!is_node && !block) {
    for (const MinecraftProperty property : minecraft_properties(out.path()))
      out.states.emplace(key_of(property), value_of(property, 0));
  }
  const auto states = split_states(block ? std::string_view(block->states) : states_in_name(name));
  if (!states) return out;
  for (const auto& [key, value] : *states) out.states.insert_or_assign(std::string(key), value);
  return out;
}

std::optional<Material> nearest_member(const MaterialTable& table, const MaterialStates& wanted) {
  const auto fits = [&](Material material) {
    return table[material].visibility != Visibility::empty;
  };
  if (wanted.family.find(':') != std::string::npos && !is_shaped_node(wanted.family)) {
    const auto exact = table.find(minecraft_material_name({wanted.family, written(wanted)}));
    if (exact && fits(*exact)) return exact;
  }
  std::optional<Material> nearest;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const Material member : table.family(wanted.family)) {
    if (!fits(member)) continue;
    const MaterialStates states = states_of_material(table[member].name);
    if (states.family != wanted.family) continue;
    const std::size_t differing = difference(states, wanted);
    if (differing > least || (differing == least && member > *nearest)) continue;
    least = differing;
    nearest = member;
  }
  return nearest;
}

}  // namespace runstone
