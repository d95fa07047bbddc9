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
  Material first = 1;             // id of the first row: the table's size before
  std::vector<MaterialRow> rows;  // 1 .. kAddedMaterialsMax; their names differ
  friend bool operator==(const AddedMaterials&, const AddedMaterials&) = default;
};

/// The rows of one record, at most. A record is then no larger than the largest edit of a player,
/// and the message about it takes a small part of a session's queue of edits.
inline constexpr std::size_t kAddedMaterialsMax = 512;
/// The maximum size of the bytes: `first` and the count, then per row the name with its length,
/// colour and visibility.
inline constexpr std::size_t kAddedMaterialsBytesMax =
    3 + 2 + kAddedMaterialsMax * (1 + kMaterialNameBytesMax + 4 + 1);

/// Fails if a row is not valid (validate_material()), if two have one name, or if their number or
/// their ids are out of range. Cost: O(n log n).
Result<void> validate(const AddedMaterials& added);

/// Appends the canonical bytes. Requires validate().
void write_added_materials(ByteWriter& w, const AddedMaterials& added);
/// Reads what write_added_materials() wrote. A failure is found in the reader. The result is not
/// validated.
AddedMaterials read_added_materials(ByteReader& r);

}  // namespace runstone
