#include "common/formats/material_match.hpp"

#include <xxhash.h>

#include <array>
#include <cstdint>

#include "common/core/text.hpp"
#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/shape_names.hpp"
#include "common/shapes/shape_states.hpp"

namespace runstone {
namespace {

std::string hash_text(const std::string& name) {
  constexpr std::array<char, 16> kDigits = {'0', '1', '2', '3', '4', '5', '6', '7',
                                            '8', '9', 'a', 'b', 'c', 'd', 'e', 'f'};
  const std::uint64_t hash = XXH3_64bits(name.data(), name.size());
  std::string text;
  for (int i = 7; i >= 0; --i) text += kDigits[hash >> (4 * i) & 15];
  return text;
}

/// Returns true if the name of a material is that of a block of Minecraft with these states.
bool has_states_in_name(const BuildMaterial& material) {
  const auto block = block_of_minecraft_material(material.row.name);
  return block && minecraft_material_name({block->name, material.states}) == material.row.name;
}

}  // namespace

std::string world_name_of(const BuildMaterial& material) {
  std::string name = material.row.name;
  const bool has_states = has_states_in_name(material) || states_in_name(name) == material.states;
  if (!material.states.empty() && !has_states) name += '[' + material.states + ']';
  if (name.size() <= kMaterialNameBytesMax) return name;
  const std::string ending = '~' + hash_text(name);
  return std::string(cut_utf8(name, kMaterialNameBytesMax - ending.size())) + ending;
}

MaterialRow world_row_of(const BuildMaterial& material) {
  MaterialRow row = material.row;
  row.name = world_name_of(material);
  if (row.shape.is_cube() && row.visibility != Visibility::empty)
    row.shape = shape_of_material_name(row.name).value_or(Shape{});
  return row;
}

MaterialMatch match_by_name(std::span<const BuildMaterial> materials, const MaterialTable& table) {
  MaterialMatch out;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    std::optional<Material> id = kEmpty;
    if (materials[i].row.visibility != Visibility::empty) {
      id = table.find(world_name_of(materials[i]));
      if (!id) out.missing.push_back(i);
    }
    out.ids.push_back(id);
  }
  return out;
}

}  // namespace runstone
