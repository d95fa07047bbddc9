// The text of an edit of the log, for the command `log`.
#pragma once
#include <string>

#include "common/edits/descriptor/edit_record.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns a line such as
///   "9120 2026-11-21T23:57:42Z ana #3 9M1Q-Z7CR-04KD player box 1 2 3 to 4 5 6 := stone"
/// where both corners are inside. `author` is a text of AuthorNames. For an undo, redo or rollback
/// the line names the edit that it refers to instead of a kind: "undo of 9100 restored 1 2 3". An
/// edit that belongs to an action of several names the first one: "player with 9100 box ...". The
/// material is left out if the edit restores voxels or pastes a clipboard, and if the table does
/// not have it. The line of a change of rights ends with rights_change_text().
std::string log_line(const EditRecord& record, const std::string& author,
                     const MaterialTable& materials);

}  // namespace runstone
