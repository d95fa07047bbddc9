// The bytes of memory that an edit descriptor takes. Server and client bound the edits that wait by
// them.
#pragma once
#include <cstddef>
#include <string>
#include <variant>

#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

/// Returns the bytes of one copy of the descriptor, without what its copies share. Cost: O(1).
inline std::size_t own_bytes(const EditDescriptor& edit) {
  const auto* stroke = std::get_if<FillStroke>(&edit.shape);
  return sizeof(EditDescriptor) + (stroke ? stroke->points.capacity() * sizeof(VoxelPos) : 0);
}

/// Returns the bytes that all copies of the descriptor share: the clipboard of a paste, or at most
/// those of a change of rights, of new materials, of shapes, of a texture or of the library,
/// otherwise 0. Cost: O(1).
inline std::size_t shared_bytes(const EditDescriptor& edit) {
  const auto* paste = std::get_if<Paste>(&edit.shape);
  if (std::holds_alternative<RightsEdit>(edit.shape)) return kRightsChangeBytesMax;
  if (const AddedMaterials* added = added_materials_of(edit))
    return added->rows.size() * (sizeof(MaterialRow) + kMaterialNameBytesMax);
  if (const GivenShapes* given = given_shapes_of(edit))
    return given->rows.size() * (sizeof(GivenShape) + kShapeBoxesMax * sizeof(ShapeBox));
  if (const GivenTexture* given = given_texture_of(edit))
    return given->png.size() + given->uses.size() * sizeof(TextureUse);
  if (std::holds_alternative<LibraryEdit>(edit.shape))
    return sizeof(LibraryChange) + kLibraryChangeBytesMax + kBuildTagsMax * sizeof(std::string);
  return paste != nullptr && paste->clipboard ? paste->clipboard->memory_bytes() : 0;
}

/// Returns the bytes of one descriptor with all that belongs to it. A clipboard that several edits
/// share counts for each of them. Cost: O(1).
inline std::size_t memory_bytes(const EditDescriptor& edit) {
  return own_bytes(edit) + shared_bytes(edit);
}

}  // namespace runstone
