// The materials of a world when a clipboard or an edit is turned or mirrored. A build of a file,
// which has names in place of a world's materials, is turned by common/formats/file_build_turn.hpp.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/core/ids.hpp"
#include "common/edits/clipboard/clipboard.hpp"
#include "common/edits/clipboard/orientation.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns the material that a material of a world becomes when its voxel is turned:
///   - the one that has the name for the new lie (turned_material_name());
///   - otherwise the first of its family whose shape looks like the turned one;
///   - otherwise nullopt: it has no turned form in this world, and stays as it is.
/// A material that the turn does not change is returned, and so is one that the table does not
/// know. Cost: that of turned_material_name(), and of the family.
std::optional<Material> turned_material(Material material, const Orientation& orientation,
                                        const MaterialTable& table);

/// The materials of a palette when it is turned.
struct TurnedMaterials {
  std::vector<std::optional<Material>>
      ids;                  // by entry; none is nullopt. As with_materials() takes them
  bool is_changed = false;  // an entry became another material
  std::size_t stuck = 0;    // entries that have no turned form in this world
};
TurnedMaterials turned_materials(std::span<const Material> palette, const Orientation& orientation,
                                 const MaterialTable& table);

/// Returns a clipboard of one descriptor with the materials for an orientation in which it is
/// pasted. Its cells do not move. Returns the clipboard itself if no material changes, or if the
/// result were too large for a descriptor. Cost: O(runs) if a material changes.
std::shared_ptr<const Clipboard> with_turned_materials(std::shared_ptr<const Clipboard> clipboard,
                                                       const Orientation& orientation,
                                                       const MaterialTable& table);

/// Returns a sentence for the player, or an empty text if no material is stuck.
std::string stuck_text(std::size_t stuck);

}  // namespace runstone
