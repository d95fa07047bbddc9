// Selection: the edits that a rollback, an undo or a redo takes back, by chunk. It is made once and then fixed:
// edits ordered later are never in it, so a job that goes on for a while takes back what it said it would.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "server/rollback/goes_on.hpp"
#include "server/store/log_reader.hpp"

namespace runstone {

/// Which edits of the log: whose, when, where and why. What is left open asks for everything.
struct SelectionFilter {
  std::vector<AuthorId> authors;                         // any of them; none named: everybody
  TimeUs from_us = std::numeric_limits<TimeUs>::min();   // UTC, included
  TimeUs until_us = std::numeric_limits<TimeUs>::max();  // included
  /// Voxels outside stay as they are, even those of an edit that reaches into the box.
  std::optional<VoxelBox> box;
  std::optional<Cause> cause;
  Sequence first = 1, last = kSequenceMax;  // both included
};

struct Selection {
  /// Per chunk that a selected edit touches, and that meets the box: the edits, ascending.
  std::map<ChunkKey, std::vector<Sequence>> chunks;
  std::optional<VoxelBox> box;  // nothing outside changes
  std::uint64_t edits = 0;
  Sequence first = 0, last = 0;          // of the selected edits; 0 without one
  TimeUs first_us = 0, last_us = 0;      // their times, UTC
  std::optional<VoxelBox> area() const;  // of the chunks, in voxels; nothing without one
  std::int32_t chunk_edge = 32;
};

/// Chunks times edits that a selection may hold: bounds its memory (8 bytes each).
inline constexpr std::uint64_t kSelectionTouchesMax = 16'000'000;

/// Asks the log. Fails with what the store says, with bad_request if the selection is too large, and with
/// cancelled once `goes_on` says no. O(edits of the answer * chunks they touch).
StoreResult<Selection> select_edits(LogReader& reader, const SelectionFilter& filter,
                                    const GoesOn& goes_on = {});

/// Exactly these edits, ascending; those that the log does not hold are left out. Fails likewise.
StoreResult<Selection> select_edits(LogReader& reader, const std::vector<Sequence>& edits,
                                    const GoesOn& goes_on = {});

}  // namespace runstone
