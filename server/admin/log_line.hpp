// One edit of the log, as the command `log` tells it.
#pragma once
#include <string>

#include "common/edits/descriptor/edit_record.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// "9120 2026-11-21T23:57:42Z ana #3 player box 1 2 3 to 4 5 6 := stone": both corners inside. `author` as AuthorNames
/// has it. Of an undo, redo or rollback also the edit that it answers ("undo of 9100"); of a paste, or of a material that
/// the table does not know, no material.
std::string log_line(const EditRecord& record, const std::string& author,
                     const MaterialTable& materials);

}  // namespace runstone
