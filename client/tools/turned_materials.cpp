#include "client/tools/turned_materials.hpp"

#include <array>
#include <cstdint>
#include <utility>

#include "common/builds/build_transforms.hpp"
#include "common/builds/paste_source.hpp"
#include "common/core/coords.hpp"
#include "common/formats/material_family.hpp"
#include "common/formats/turned_names.hpp"
#include "common/shapes/turned_shape.hpp"

namespace runstone {

std::optional<Material> turned_material(Material material, const Orientation& orientation,
                                        const MaterialTable& table) {
  if (material == kEmpty || !table.knows(material) || orientation == Orientation{}) return material;
  const MaterialInfo& info = table[material];
  const std::array<Axis, 3> along = {orientation.along(Axis::x), orientation.along(Axis::y),
                                     orientation.along(Axis::z)};
  const auto name = turned_material_name(info.name, along, orientation.flips);
  if (name && *name != info.name) {
    if (const auto found = table.find(*name)) return found;
  }
  const Shape wanted = turned(info.shape, along, orientation.flips);
  const bool looks_alike = look_alike(info.shape, wanted);
  if (looks_alike && name == info.name) return material;
  if (!looks_alike) {
    for (const Material member : table.family(states_of_material(info.name).family)) {
      if (look_alike(table[member].shape, wanted)) return member;
    }
  }
  return std::nullopt;
}

TurnedMaterials turned_materials(std::span<const Material> palette, const Orientation& orientation,
                                 const MaterialTable& table) {
  TurnedMaterials out;
  for (const Material material : palette) {
    const auto now = turned_material(material, orientation, table);
    if (!now) ++out.stuck;
    if (now && *now != material) out.is_changed = true;
    out.ids.push_back(now.value_or(material));
  }
  return out;
}

std::shared_ptr<const Clipboard> with_turned_materials(std::shared_ptr<const Clipboard> clipboard,
                                                       const Orientation& orientation,
                                                       const MaterialTable& table) {
  const TurnedMaterials materials = turned_materials(clipboard->palette(), orientation, table);
  if (!materials.is_changed) return clipboard;
  auto build = with_materials(*build_of(*clipboard), materials.ids);
  if (!build) return clipboard;
  PasteLimits any_volume;
  any_volume.volume_max = UINT64_MAX;
  auto made = whole_clipboard(**build, EmptyCells::pasted, any_volume);
  return made ? std::move(made) : std::move(clipboard);
}

std::string stuck_text(std::size_t stuck) {
  if (stuck == 0) return {};
  if (stuck == 1) return "1 material has no turned form in this world, and lies as before";
  return std::to_string(stuck) + " materials have no turned form in this world, and lie as before";
}

}  // namespace runstone
