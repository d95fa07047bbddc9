// AddedMaterials: rows that a record of the log appends to the world's material table.
// docs/edit-log.md specifies the bytes.
#pragma once
#include <cstddef>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "common/core/material_row.hpp"
#include "common/core/result.hpp"

namespace runstone {

struct AddedMaterials {
  Material first = 1;  // id of the first row: the table's size before
  /// 1 .. kAddedMaterialsMax; their names differ. They are cubes: another record gives them shapes.
  std::vector<MaterialRow> rows;
  friend bool operator==(const AddedMaterials&, const AddedMaterials&) = default;
};

/// The rows of one record, at most. A record is then no larger than the largest edit of a player,
/// and the message about it takes a small part of a session's queue of edits.
inline constexpr std::size_t kAddedMaterialsMax = 512;
/// The maximum size of the bytes without looks: `first` and the count, then per row the name with
/// its length, colour and visibility.
inline constexpr std::size_t kAddedMaterialsBytesMax =
    3 + 2 + kAddedMaterialsMax * (1 + kMaterialNameBytesMax + 4 + 1);
/// The maximum size of the looks.
inline constexpr std::size_t kLookBytes = 5;
inline constexpr std::size_t kAddedLooksBytesMax = kAddedMaterialsMax * kLookBytes;

/// Returns true if a row has a look. Then the bytes are those of the kind `materials_with_looks`,
/// otherwise those of the kind `materials`. Cost: O(rows).
bool has_looks(const AddedMaterials& added);

/// Fails if a row is not valid (validate_material()) or has a shape, if two have one name, or if
/// their number or their ids are out of range. Cost: O(n log n).
Result<void> validate(const AddedMaterials& added);

/// Appends the canonical bytes. Requires validate().
void write_added_materials(ByteWriter& w, const AddedMaterials& added);
/// Reads what write_added_materials() wrote; `with_looks` is the kind. A failure is found in the
/// reader, also if bytes of the kind with looks have none. The result is not validated.
AddedMaterials read_added_materials(ByteReader& r, bool with_looks);

}  // namespace runstone
