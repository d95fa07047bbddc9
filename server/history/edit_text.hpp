// The text of an edit of voxels, for people.
#pragma once
#include <string>

#include "common/edits/descriptor/edit_record.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns true if records of this cause take edits back, or make them again. They are pastes.
constexpr bool restores(Cause cause) {
  return cause == Cause::undo || cause == Cause::redo || cause == Cause::rollback;
}

/// Returns what an edit did and where, such as "box 1 2 3 to 4 5 6 := stone", with the first and
/// the last voxel of its bounding box. If the cause restores(), the word is "restored". Requires an
/// edit of voxels.
std::string edit_text(const EditRecord& record, const MaterialTable& materials);

}  // namespace runstone
