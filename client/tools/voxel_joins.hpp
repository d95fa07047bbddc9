// Voxel joins: fences, panes and walls that join their neighbours. The states are chosen when a
// voxel is placed or removed, as edits, and never by drawing: so all clients see one world. Pure.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "client/tools/tool_action.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns the material of a voxel, or nullopt if it is not known.
using VoxelReader = std::function<std::optional<Material>(VoxelPos)>;

/// Returns the member of a material's family that joins the four neighbours of a place, or the
/// material if its family joins nothing. Of the members that the table has, the one with the fewest
/// states that differ. These join:
///   - fences: fences, but those of nether brick only each other;
///   - panes, bars and walls: each other;
///   - fences and walls: fence gates on the two sides of their posts;
///   - all of them: cubes that stop a body but for leaves, and shapes that fill the side of the
///     voxel.
/// Cost: O(rules), some 10 microseconds for each neighbour with a shape, and that of
/// nearest_member().
Material joined_material(VoxelPos at, Material material, const MaterialTable& table,
                         const VoxelReader& voxels);

/// Returns the edits that set a voxel: first the voxel itself, joined if it joins, and then those
/// neighbours that join and change, of which only the side towards it changes. Each edit of a
/// neighbour has a mask, so that it changes nothing if somebody else has changed the neighbour. At
/// most five edits. Neighbours that are not known do not change. Cost: that of five
/// joined_material().
std::vector<EditDescriptor> joined_edits(VoxelPos at, Material material, const MaterialTable& table,
                                         const VoxelReader& voxels);

/// A box with more voxels is filled as it is.
inline constexpr std::uint64_t kJoinedBoxVoxelsMax = 4'096;

/// Returns what fills a box that is one voxel thick along x or z: the edit, in which each voxel is
/// the member that joins its neighbours, and behind it the edits of neighbours that join and change
/// (ToolAction::has_followers), as those of joined_edits(). Voxels that the edit's mask does not
/// admit are neighbours, too. Returns the edit alone if it fills another box, one with a side of
/// more than kSideMax, or one with more than kJoinedBoxVoxelsMax voxels. Requires a FillBox. Cost:
/// O(voxels), and that of joined_material() for each combination of neighbours.
ToolAction joined_box(const EditDescriptor& fill, const MaterialTable& table,
                      const VoxelReader& voxels);
/// Returns joined_box() of a box, joined_edits() of a voxel, and any other edit alone.
ToolAction joined_action(const EditDescriptor& edit, const MaterialTable& table,
                         const VoxelReader& voxels);

}  // namespace runstone
