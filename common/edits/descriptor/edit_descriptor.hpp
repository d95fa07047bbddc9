// EditDescriptor: the effect of an edit as geometry, a mask and a material. A whole brush stroke or
// pasted clipboard is one record. The effect on a chunk depends only on the descriptor and that
// chunk's voxels. The canonical bytes (tag + varints, docs/edit-log.md) are the same on the wire,
// in the log and in exports. The meaning of a kind is frozen; a change is a new kind. Some kinds
// have no voxels: they change who may do what, add materials, give them shapes or textures, change
// the library of builds, set the clock of the world, or stand for a lost record. They stand in the
// same order as the others.
#pragma once
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/core/world_time.hpp"
#include "common/edits/clipboard/clipboard.hpp"
#include "common/edits/clipboard/orientation.hpp"
#include "common/edits/descriptor/added_materials.hpp"
#include "common/edits/descriptor/given_shapes.hpp"
#include "common/edits/descriptor/given_texture.hpp"
#include "common/edits/descriptor/library_change.hpp"
#include "common/rights/rights_change.hpp"

namespace runstone {

/// The tags of the kinds, as they are stored. 5 is unused, because fill_box with the mask
/// only_material replaces a material in a box.
enum class EditKind : std::uint8_t {
  set_voxel = 1,
  fill_box = 2,
  fill_sphere = 3,
  fill_stroke = 4,
  paste = 6,
  rights = 7,
  materials = 8,
  materials_with_looks = 9,  // of which at least one has a look
  library = 10,
  shapes = 11,
  texture = 12,
  clock = 13,
  gap = 14
};

/// The condition on the present voxels of the geometry that an edit may write. The values are
/// stored.
enum class MaskKind : std::uint8_t {
  everything = 0,
  only_empty = 1,
  only_solid = 2,
  only_material = 3
};

struct Mask {
  MaskKind kind = MaskKind::everything;
  Material material = kEmpty;  // for only_material; kEmpty otherwise
  friend bool operator==(const Mask&, const Mask&) = default;
  bool admits(Material present) const {
    switch (kind) {
      case MaskKind::everything:
        return true;
      case MaskKind::only_empty:
        return present == kEmpty;
      case MaskKind::only_solid:
        return present != kEmpty;
      case MaskKind::only_material:
        return present == material;
    }
    return false;
  }
};

struct SetVoxel {
  VoxelPos at;
  friend bool operator==(const SetVoxel&, const SetVoxel&) = default;
};

struct FillBox {
  VoxelBox box;  // not empty
  friend bool operator==(const FillBox&, const FillBox&) = default;
};

/// Voxels whose integer offset d from the centre has |d|^2 <= r^2 + r, that is |d| < r + 1/2.
struct FillSphere {
  VoxelPos centre;
  std::uint16_t radius = 0;
  friend bool operator==(const FillSphere&, const FillSphere&) = default;
};

/// Voxels whose squared distance to some segment of the polyline through `points` is at most r^2 +
/// r: a sphere drawn along it. A single point is a sphere, not a stroke. Radius 0 would leave gaps.
struct FillStroke {
  std::vector<VoxelPos> points;  // 2 .. kStrokePointsMax; consecutive points differ
  std::uint16_t radius = 1;      // 1 .. kEditRadiusMax
  friend bool operator==(const FillStroke&, const FillStroke&) = default;
};

/// The touched cells of a clipboard, each with its own material.
struct Paste {
  // Smallest corner in the world of the whole rotated clipboard, untouched cells included.
  VoxelPos at;
  std::shared_ptr<const Clipboard> clipboard;
  Orientation orientation;
  friend bool operator==(const Paste& a, const Paste& b) {
    const bool same =
        a.clipboard == b.clipboard ||
        (a.clipboard != nullptr && b.clipboard != nullptr && *a.clipboard == *b.clipboard);
    return same && a.at == b.at && a.orientation == b.orientation;
  }
};

/// Changes roles, restrictions or protected ground. It has no voxels and touches no chunk.
struct RightsEdit {
  std::shared_ptr<const RightsChange> change;
  friend bool operator==(const RightsEdit& a, const RightsEdit& b) {
    return a.change == b.change ||
           (a.change != nullptr && b.change != nullptr && *a.change == *b.change);
  }
};

/// Adds materials to the world. It has no voxels and touches no chunk.
struct MaterialsEdit {
  std::shared_ptr<const AddedMaterials> added;
  friend bool operator==(const MaterialsEdit& a, const MaterialsEdit& b) {
    return a.added == b.added || (a.added != nullptr && b.added != nullptr && *a.added == *b.added);
  }
};

/// Changes the library of builds. It has no voxels and touches no chunk.
struct LibraryEdit {
  std::shared_ptr<const LibraryChange> change;
  friend bool operator==(const LibraryEdit& a, const LibraryEdit& b) {
    return a.change == b.change ||
           (a.change != nullptr && b.change != nullptr && *a.change == *b.change);
  }
};

/// Gives shapes to materials of the world. It has no voxels and touches no chunk.
struct ShapesEdit {
  std::shared_ptr<const GivenShapes> given;
  friend bool operator==(const ShapesEdit& a, const ShapesEdit& b) {
    return a.given == b.given || (a.given != nullptr && b.given != nullptr && *a.given == *b.given);
  }
};

/// Gives a picture to sides of materials of the world. It has no voxels and touches no chunk.
struct TextureEdit {
  std::shared_ptr<const GivenTexture> given;
  friend bool operator==(const TextureEdit& a, const TextureEdit& b) {
    return a.given == b.given || (a.given != nullptr && b.given != nullptr && *a.given == *b.given);
  }
};

/// Sets the clock of the world. It has no voxels and touches no chunk.
struct ClockEdit {
  WorldTime time;  // from when the edit is ordered
  friend bool operator==(const ClockEdit&, const ClockEdit&) = default;
};

/// Stands in the log for a record that was lost, so that sequence numbers have no gaps. It has no
/// voxels and touches no chunk.
struct GapEdit {
  AuthorId author = 0;  // of the lost record; 0: the server, or not known
  // The lost record corrected the time of the log: times may fall here.
  bool begins_era = false;
  friend bool operator==(const GapEdit&, const GapEdit&) = default;
};

// The order is that of EditKind. Both kinds of new materials are MaterialsEdit.
using EditShape =
    std::variant<SetVoxel, FillBox, FillSphere, FillStroke, Paste, RightsEdit, MaterialsEdit,
                 LibraryEdit, ShapesEdit, TextureEdit, ClockEdit, GapEdit>;

struct EditDescriptor {
  EditShape shape;
  Mask mask;
  // kEmpty removes voxels. It is kEmpty for a paste, whose cells have their own materials, and for
  // edits without voxels, which have no mask either.
  Material material = kEmpty;
  friend bool operator==(const EditDescriptor&, const EditDescriptor&) = default;
};

/// Limits of the encoding. Servers allow less (protocol/limits.hpp, server configuration).
inline constexpr std::int32_t kEditBoxSideMax = 4096;
inline constexpr std::uint16_t kEditRadiusMax = 512;
inline constexpr std::size_t kStrokePointsMax = 256;
inline constexpr std::int32_t kStrokeStepMax = 1024;  // from point to point, along each axis

EditKind kind_of(const EditDescriptor& edit);

/// Returns the descriptor of a change of rights.
EditDescriptor rights_edit(RightsChange change);
/// Returns the change of a descriptor that changes rights; null for the other kinds.
inline const RightsChange* rights_change_of(const EditDescriptor& edit) {
  const auto* rights = std::get_if<RightsEdit>(&edit.shape);
  return rights == nullptr ? nullptr : rights->change.get();
}
/// Returns the descriptor that adds materials.
EditDescriptor materials_edit(AddedMaterials added);
/// Returns the materials of a descriptor that adds some; null for the other kinds.
inline const AddedMaterials* added_materials_of(const EditDescriptor& edit) {
  const auto* materials = std::get_if<MaterialsEdit>(&edit.shape);
  return materials == nullptr ? nullptr : materials->added.get();
}
/// Returns the descriptor of a change of the library.
EditDescriptor library_edit(LibraryChange change);
/// Returns the change of a descriptor that changes the library; null for the other kinds.
inline const LibraryChange* library_change_of(const EditDescriptor& edit) {
  const auto* library = std::get_if<LibraryEdit>(&edit.shape);
  return library == nullptr ? nullptr : library->change.get();
}
/// Returns the descriptor that gives shapes.
EditDescriptor shapes_edit(GivenShapes given);
/// Returns the shapes of a descriptor that gives some; null for the other kinds.
inline const GivenShapes* given_shapes_of(const EditDescriptor& edit) {
  const auto* shapes = std::get_if<ShapesEdit>(&edit.shape);
  return shapes == nullptr ? nullptr : shapes->given.get();
}
/// Returns the descriptor that gives a picture.
EditDescriptor texture_edit(GivenTexture given);
/// Returns the picture of a descriptor that gives one; null for the other kinds.
inline const GivenTexture* given_texture_of(const EditDescriptor& edit) {
  const auto* texture = std::get_if<TextureEdit>(&edit.shape);
  return texture == nullptr ? nullptr : texture->given.get();
}
/// Returns the descriptor that sets the clock of the world.
EditDescriptor clock_edit(const WorldTime& time);
/// Returns the time of a descriptor that sets the clock; null for the other kinds.
inline const WorldTime* world_time_of(const EditDescriptor& edit) {
  const auto* clock = std::get_if<ClockEdit>(&edit.shape);
  return clock == nullptr ? nullptr : &clock->time;
}
/// Returns the descriptor of a gap.
EditDescriptor gap_edit(const GapEdit& gap);
/// Returns the gap of a descriptor that stands for a lost record; null for the other kinds.
inline const GapEdit* gap_of(const EditDescriptor& edit) {
  return std::get_if<GapEdit>(&edit.shape);
}
/// Returns true if the edit adds materials or gives shapes to some: it changes the material table.
inline bool changes_materials(const EditDescriptor& edit) {
  return std::holds_alternative<MaterialsEdit>(edit.shape) ||
         std::holds_alternative<ShapesEdit>(edit.shape);
}
/// Returns false if the kind of the edit has no voxels.
inline bool has_voxels(const EditDescriptor& edit) {
  return !std::holds_alternative<RightsEdit>(edit.shape) &&
         !std::holds_alternative<MaterialsEdit>(edit.shape) &&
         !std::holds_alternative<LibraryEdit>(edit.shape) &&
         !std::holds_alternative<ShapesEdit>(edit.shape) &&
         !std::holds_alternative<TextureEdit>(edit.shape) &&
         !std::holds_alternative<ClockEdit>(edit.shape) &&
         !std::holds_alternative<GapEdit>(edit.shape);
}

/// Returns the maximum number of bytes of a descriptor of this kind.
constexpr std::size_t descriptor_bytes_max(EditKind kind) {
  if (kind == EditKind::paste) return 64 + kClipboardBytesMax;
  if (kind == EditKind::rights) return 64 + kRightsChangeBytesMax;
  if (kind == EditKind::materials) return 64 + kAddedMaterialsBytesMax;
  if (kind == EditKind::materials_with_looks)
    return 64 + kAddedMaterialsBytesMax + kAddedLooksBytesMax;
  if (kind == EditKind::library) return 64 + kLibraryChangeBytesMax;
  if (kind == EditKind::shapes) return 64 + kGivenShapesBytesMax;
  if (kind == EditKind::texture) return 64 + kGivenTextureBytesMax;
  return kind == EditKind::fill_stroke ? 1600 : 64;
}
// Maximum over all kinds.
inline constexpr std::size_t kDescriptorBytesMax = descriptor_bytes_max(EditKind::paste);
static_assert(descriptor_bytes_max(EditKind::materials_with_looks) <= kDescriptorBytesMax);
static_assert(descriptor_bytes_max(EditKind::shapes) <= kDescriptorBytesMax);
static_assert(descriptor_bytes_max(EditKind::texture) <= kDescriptorBytesMax);

/// Fails with the first field outside its range: a position beyond the world, an empty or oversized
/// box, a radius, the points of a stroke, a paste without a clipboard. A clipboard is always valid.
/// Cost: O(1); stroke: O(points).
Result<void> validate(const EditDescriptor& edit);

/// Returns the largest id among the materials that the edit writes or has in its mask. A table that
/// knows it knows all of them. Requires a valid descriptor. Cost: O(1).
Material material_max(const EditDescriptor& edit);

/// Appends the canonical bytes. Requires a valid descriptor.
void encode(const EditDescriptor& edit, Bytes& out);
Bytes encode(const EditDescriptor& edit);

/// Decodes exactly one descriptor. Fails if bytes are left over or are not canonical. The result is
/// valid.
Result<EditDescriptor> decode_descriptor(ByteView in);
/// Decodes a descriptor as decode_descriptor(). Fails also for a kind without voxels, which players
/// neither send nor receive as an edit.
Result<EditDescriptor> decode_voxel_edit(ByteView in);

}  // namespace runstone
