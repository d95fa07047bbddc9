// DigestList: the digests of a set of chunks as a JSON file, the paper on which server, clients and replay
// compare what they hold (docs/replay.md gives the format). File access belongs to programs: call it from no
// strand.
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
  Sequence seq = 0;                      // where the holder stood when it wrote the list
  std::vector<DigestCheckEntry> chunks;  // any order
  bool is_clean = true;  // false: chunks stand at their own versions, and not together at `seq`
};

/// JSON text, chunks ascending by key, one line each: equal lists give equal bytes.
std::string to_json(const DigestList& list);
/// The reverse; other keys are ignored, so that a file may say more. A list that is not clean is refused: it
/// cannot be compared with anything. `file` is only for messages.
Result<DigestList, TextError> parse_digests_json(std::string_view json, std::string_view file);

/// Writes the file whole or not at all (a new file takes the old one's place).
Result<void, TextError> write_digests_json(const std::string& file, const DigestList& list);
Result<DigestList, TextError> read_digests_json(const std::string& file);

/// The two halves of write_digests_json() and read_digests_json(), for files that say more.
Result<void, TextError> write_text_file(const std::string& file, std::string_view text);

}  // namespace runstone
