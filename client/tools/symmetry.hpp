// Symmetry: copies each edit to the other sides of one or two vertical mirror planes through one
// place.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/coords.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

enum class SymmetryKind : std::uint8_t {
  none,
  x,      // one plane across the x axis
  z,      // one plane across the z axis
  both,   // both planes: four copies
  point,  // a half turn about the vertical line through the centre: two copies
};

struct Symmetry {
  SymmetryKind kind = SymmetryKind::none;
  /// Twice the coordinates of the centre. An even number is the middle of a voxel, and an odd one
  /// is the border between two voxels. The voxel at x is mirrored to centre2_x - x.
  std::int32_t centre2_x = 0, centre2_z = 0;
  friend bool operator==(const Symmetry&, const Symmetry&) = default;
};

/// Returns the edit mirrored along an axis: the voxel at coordinate v moves to centre2 - v.
/// Requires a valid edit that has voxels.
EditDescriptor mirrored(const EditDescriptor& edit, Axis axis, std::int32_t centre2);

/// Returns the edits and their copies, each once. If there are copies, they are merged into one
/// edit where merge_edits() can do it.
std::vector<EditDescriptor> with_copies(std::vector<EditDescriptor> edits,
                                        const Symmetry& symmetry);

}  // namespace runstone
