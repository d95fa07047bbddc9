#include "common/formats/material_match.hpp"

#include <xxhash.h>

#include <array>
#include <cstdint>
#include <limits>

#include "common/core/text.hpp"
#include "common/formats/minecraft_blocks.hpp"

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

/// Returns a distance that weighs the parts of a colour by how the eye sees them: the "redmean"
/// approximation of T. Riemersma (CompuPhase).
std::int64_t colour_distance(const MaterialColour& a, const MaterialColour& b) {
  const int red_mean = (a[0] + b[0]) / 2;
  const std::int64_t red = a[0] - b[0], green = a[1] - b[1], blue = a[2] - b[2];
  const std::int64_t alpha = a[3] - b[3];
  return (512 + red_mean) * red * red + 1024 * green * green + (767 - red_mean) * blue * blue +
         512 * alpha * alpha;
}

}  // namespace

std::string world_name_of(const BuildMaterial& material) {
  std::string name = material.row.name;
  const bool has_states = block_of_minecraft_material(name).has_value();
  if (!material.states.empty() && !has_states) name += '[' + material.states + ']';
  if (name.size() <= kMaterialNameBytesMax) return name;
  const std::string ending = '~' + hash_text(name);
  return std::string(cut_utf8(name, kMaterialNameBytesMax - ending.size())) + ending;
}

MaterialRow world_row_of(const BuildMaterial& material) {
  MaterialRow row = material.row;
  row.name = world_name_of(material);
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

Material nearest_material(const MaterialRow& row, const MaterialTable& table) {
  Material nearest = kEmpty;
  bool has_same = false;
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (std::size_t id = 1; id < table.size(); ++id) {
    const MaterialInfo& info = table[static_cast<Material>(id)];
    if (info.visibility == Visibility::empty) continue;
    const bool is_same = info.visibility == row.visibility;
    if (has_same && !is_same) continue;
    const std::int64_t distance = colour_distance(info.colour, row.colour);
    if (is_same == has_same && distance >= least) continue;
    has_same = is_same;
    least = distance;
    nearest = static_cast<Material>(id);
  }
  return nearest;
}

}  // namespace runstone
