// RecordedLog: the edits of an .rlog by author, to be made again elsewhere. It is whole in memory:
// every descriptor of the file, clipboards of pastes included, and a time for each.
#pragma once
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/materials/material_table.hpp"
#include "common/rlog/rlog_reader.hpp"

namespace runstone {

struct RecordedEdit {
  TimeUs offset_us = 0;  // since the first edit of the file; never decreases
  EditDescriptor edit;
};

struct RecordedAuthor {
  AuthorId author = 0;  // in the recorded world; 0: its server
  std::string name;     // valid as the name of a session
  std::vector<RecordedEdit> edits;
};

struct RecordedLog {
  std::vector<RecordedAuthor> authors;  // those with edits, ascending
  std::uint64_t edits = 0;
  MaterialTable materials;     // of the recorded world
  std::vector<Material> used;  // used by the edits and their masks, ascending; all in `materials`
};

/// Reads and verifies the whole file. Fails if it is damaged anywhere. The error is one line that
/// names the edit and the byte of the file.
Result<RecordedLog, std::string> read_recorded_log(RlogSource source);

/// Fails if a material that the edits use has another name in `live`. The error names the first
/// one.
Result<void, std::string> check_materials(const RecordedLog& log, const MaterialTable& live);

/// Returns the recorded name of the player, cut to kPlayerNameBytesMax. Returns a name like "author
/// 7" if that is no name (is_plain_name()).
std::string session_name(const std::string& recorded, AuthorId author);

}  // namespace runstone
