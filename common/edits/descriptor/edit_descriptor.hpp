// EditDescriptor: what an edit does, as geometry, a mask and a material. One record for a whole brush stroke
// or pasted clipboard. Its effect on a chunk depends only on the descriptor and that chunk's voxels.
// The canonical bytes (tag + varints, docs/edit-log.md) are the same on the wire, in the log and in exports.
// A kind's meaning is frozen; a change is a new kind.
#pragma once
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/edits/clipboard/clipboard.hpp"
#include "common/edits/clipboard/orientation.hpp"

namespace runstone {

/// Tags, stored. 5 is unused: to replace a material in a box is fill_box with the mask only_material.
enum class EditKind : std::uint8_t {
  set_voxel = 1,
  fill_box = 2,
  fill_sphere = 3,
  fill_stroke = 4,
  paste = 6
};

/// Which voxels of the geometry an edit may write. Stored.
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

/// Voxels whose squared distance to some segment of the polyline through `points` is at most r^2 + r: a
/// sphere drawn along it. A single point is a sphere, not a stroke; radius 0 would leave gaps.
struct FillStroke {
  std::vector<VoxelPos> points;  // 2 .. kStrokePointsMax, no two equal ones in a row
  std::uint16_t radius = 1;      // 1 .. kEditRadiusMax
  friend bool operator==(const FillStroke&, const FillStroke&) = default;
};

/// The touched cells of a clipboard, each with its own material.
struct Paste {
  VoxelPos
      at;  // smallest corner in the world of the whole clipboard as it is turned, touched there or not
  std::shared_ptr<const Clipboard> clipboard;
  Orientation orientation;
  friend bool operator==(const Paste& a, const Paste& b) {
    const bool same =
        a.clipboard == b.clipboard ||
        (a.clipboard != nullptr && b.clipboard != nullptr && *a.clipboard == *b.clipboard);
    return same && a.at == b.at && a.orientation == b.orientation;
  }
};

using EditShape =
    std::variant<SetVoxel, FillBox, FillSphere, FillStroke, Paste>;  // order follows EditKind

struct EditDescriptor {
  EditShape shape;
  Mask mask;
  Material material = kEmpty;  // kEmpty removes; kEmpty for a paste, whose cells have theirs
  friend bool operator==(const EditDescriptor&, const EditDescriptor&) = default;
};

/// What the encoding can say at all. Servers allow less (protocol/limits.hpp, server configuration).
inline constexpr std::int32_t kEditBoxSideMax = 4096;
inline constexpr std::uint16_t kEditRadiusMax = 512;
inline constexpr std::size_t kStrokePointsMax = 256;
inline constexpr std::int32_t kStrokeStepMax = 1024;  // from point to point, along each axis

EditKind kind_of(const EditDescriptor& edit);

/// Bytes that a descriptor of this kind may have.
constexpr std::size_t descriptor_bytes_max(EditKind kind) {
  if (kind == EditKind::paste) return 64 + kClipboardBytesMax;
  return kind == EditKind::fill_stroke ? 1600 : 64;
}
inline constexpr std::size_t kDescriptorBytesMax = descriptor_bytes_max(EditKind::paste);  // of all

/// Names the first field outside its range (position beyond the world, empty or oversized box, radius, a
/// stroke's points, a paste without a clipboard). A clipboard is valid in itself. O(1); stroke: O(points).
Result<void> validate(const EditDescriptor& edit);

/// Largest id among the materials that the edit writes and asks for in its mask: a table that knows it knows
/// all of them. Requires a valid descriptor. O(1).
Material material_max(const EditDescriptor& edit);

/// Appends the canonical bytes. Requires a valid descriptor.
void encode(const EditDescriptor& edit, Bytes& out);
Bytes encode(const EditDescriptor& edit);

/// Exactly one descriptor and nothing else; only canonical bytes pass. The result is valid.
Result<EditDescriptor> decode_descriptor(ByteView in);

}  // namespace runstone
