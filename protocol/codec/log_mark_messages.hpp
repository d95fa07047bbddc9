// The messages by which a client learns who edited when: marks of the log, for a timeline (feature
// bit 7).
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

/// Asks for `count` records of the log, evenly spaced from `first` to `last`, both included.
/// Records that the log does not have are left out. A later request replaces an earlier one that
/// was not answered. With `at` (feature bit 25), asks for one mark instead, wherever it is in the
/// log: that of the record that set this voxel last.
struct LogMarksRequest {
  std::uint32_t request = 1;                  // from 1, ascending
  Sequence first = 1, last = 1;               // 1 <= first <= last
  std::uint8_t count = 1;                     // 1 .. kLogMarksMax
  std::optional<VoxelPos> at = std::nullopt;  // inside the world
  friend bool operator==(const LogMarksRequest&, const LogMarksRequest&) = default;
};

/// One record of the log, without its edit.
struct LogMark {
  Sequence seq = 1;
  TimeUs utc_us = 0;    // when it was ordered
  AuthorId author = 0;  // 0: the server
  Cause cause = Cause::player;
  EditKind kind = EditKind::set_voxel;  // a reader accepts kinds that it does not know
  friend bool operator==(const LogMark&, const LogMark&) = default;
};

/// The author of marks, by the name that the player had last.
struct LogAuthor {
  AuthorId author = 1;
  std::string name;  // 1 .. kPlayerNameBytesMax bytes
  friend bool operator==(const LogAuthor&, const LogAuthor&) = default;
};

struct LogMarks {
  std::uint32_t request = 1;       // the one that is answered
  Sequence first = 1;              // of the log: earlier records were compacted away; at least 1
  std::vector<LogMark> marks;      // ascending by seq, kLogMarksMax at most
  std::vector<LogAuthor> authors;  // of the marks, as far as their names are known; ascending
  std::string refusal;             // why there are no marks; empty: the request was not refused
  friend bool operator==(const LogMarks&, const LogMarks&) = default;
};

}  // namespace runstone
