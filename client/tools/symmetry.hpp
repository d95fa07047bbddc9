// Symmetry: copies each edit to the other sides of one or two vertical mirror planes through one
// place.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "client/tools/tool_action.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/materials/material_table.hpp"

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

/// Returns the edit mirrored along an axis: the voxel at coordinate v moves to centre2 - v, and
/// materials become their mirrored forms (turned_material()). Requires a valid edit that has
/// voxels.
EditDescriptor mirrored(const EditDescriptor& edit, Axis axis, std::int32_t centre2,
                        const MaterialTable& materials);

/// Returns the edits and their copies, each once. If there are copies, they are merged into one
/// edit where merge_edits() can do it. Each material is mirrored once. Cost: O(edits), and that of
/// turned_material() for each material.
std::vector<EditDescriptor> with_copies(std::vector<EditDescriptor> edits, const Symmetry& symmetry,
                                        const MaterialTable& materials);

/// The mirrored forms of one build, so that a build that is pasted again and again is mirrored once.
/// One thread.
class MirroredBuilds {
 public:
  /// Returns the build mirrored along x, z or both, with the mirrored materials. Keeps the forms of
  /// the last build that was asked for. Call forget() when the table changes. Fails as turned()
  /// does. Cost: that of turned() for a new form, otherwise O(1).
  Result<BuildPtr> mirrored(const BuildPtr& build, bool along_x, bool along_z,
                            const MaterialTable& materials);
  void forget() { *this = MirroredBuilds(); }

 private:
  BuildPtr build_;
  std::array<BuildPtr, 4> forms_;  // bit 0: along x; bit 1: along z
};

/// The axes along which a copy is mirrored.
struct MirrorAxes {
  bool x = false, z = false;
};

/// Returns the axes of each copy that a symmetry makes besides the original.
std::vector<MirrorAxes> copies_of(SymmetryKind kind);

/// Returns the place of a box with these sides after it was mirrored about the centre.
VoxelPos mirrored_corner(VoxelPos at, VoxelPos sides, MirrorAxes axes, const Symmetry& symmetry);

/// Returns the copy of a paste, which is no difference. Fails with words for the player if the
/// mirrored build takes too much memory, or if the copy reaches outside the world.
Result<BuildPaste, std::string> mirrored(const BuildPaste& paste, MirrorAxes axes,
                                         const Symmetry& symmetry, MirroredBuilds& builds,
                                         const MaterialTable& materials);

/// Returns an action with the copies of its edits, as with_copies() above makes them, and with those
/// of its pastes and of its pattern. Fails as mirrored() does.
Result<ToolAction, std::string> with_copies(ToolAction action, const Symmetry& symmetry,
                                            MirroredBuilds& builds, const MaterialTable& materials);

}  // namespace runstone
