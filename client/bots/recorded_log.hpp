// RecordedLog: the edits of an .rlog, sorted by who made them, to be made again elsewhere. Whole in memory: every
// descriptor of the file (clipboards of pastes included) and a time each. Plain values.
#pragma once
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/materials/material_table.hpp"
#include "common/rlog/rlog_reader.hpp"

namespace runstone {

struct RecordedEdit {
  TimeUs offset_us = 0;  // since the first edit of the file; never falls
  EditDescriptor edit;
};

struct RecordedAuthor {
  AuthorId author = 0;  // in the recorded world; 0: its server
  std::string name;     // one that a session may have
  std::vector<RecordedEdit> edits;
};

struct RecordedLog {
  std::vector<RecordedAuthor> authors;  // those with edits, ascending
  std::uint64_t edits = 0;
  MaterialTable materials;     // of the recorded world
  std::vector<Material> used;  // by the edits, masks included, ascending; `materials` knows them
};

/// Reads and verifies all of it; nothing of a file that is damaged anywhere. The error is one line that names
/// edit and byte of the file.
Result<RecordedLog, std::string> read_recorded_log(RlogSource source);

/// Whether each material that the edits use has the same name in this table. The error names the first that
/// has not.
Result<void, std::string> check_materials(const RecordedLog& log, const MaterialTable& live);

/// The recorded player's name as far as a session may have it: cut to kPlayerNameBytesMax; "author 7" in place of one
/// that is empty or no text.
std::string session_name(const std::string& recorded, AuthorId author);

}  // namespace runstone
