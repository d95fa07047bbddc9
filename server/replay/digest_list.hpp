// DigestList: the digests of a set of chunks as a JSON file. Server, clients and replay compare
// their voxels with it (docs/replay.md has the format). Thread: no strand, because file access
// blocks.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

struct DigestList {
  WorldId world_id{};
  Sequence seq = 0;                      // last sequence number of the writer
  std::vector<DigestCheckEntry> chunks;  // any order
  bool is_clean = true;  // false: the chunks do not all belong to the world after `seq`
};

/// Returns JSON text with the chunks ascending by key, one on each line. Equal lists give equal
/// bytes.
std::string to_json(const DigestList& list);
/// Parses the text of to_json(). Unknown keys are ignored. Fails if the list is not clean, because
/// such a list cannot be compared with a world. `file` is only for messages.
Result<DigestList, TextError> parse_digests_json(std::string_view json, std::string_view file);

/// Writes the list as write_output_file() does.
Result<void, std::string> write_digests_json(const std::string& file, const DigestList& list);
/// Reads what write_digests_json() wrote. `file` may also be a pipe, which is read to its end. Fails
/// if parse_digests_json() fails, or if the file is of another kind, cannot be read or has more than
/// 4 GiB.
Result<DigestList, TextError> read_digests_json(const std::string& file);

}  // namespace runstone
