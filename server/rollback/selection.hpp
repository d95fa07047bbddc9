// Selection: the edits that a rollback, an undo or a redo takes back, by chunk. It is made once and
// does not change: edits ordered later are never in it, so that a long job takes back what its
// preview showed.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "server/rollback/should_continue.hpp"
#include "server/store/log_reader.hpp"

namespace runstone {

/// Conditions on the edits of a selection. A condition that is not set holds for every edit.
struct SelectionFilter {
  std::vector<AuthorId> authors;                         // any of them; empty: every author
  std::vector<AuthorId> excluded_authors;                // none of them, ascending
  TimeUs from_us = std::numeric_limits<TimeUs>::min();   // UTC, included
  TimeUs until_us = std::numeric_limits<TimeUs>::max();  // included
  /// Voxels outside the box stay as they are, even those of an edit that reaches into it.
  std::optional<VoxelBox> box;
  std::optional<Cause> cause;
  Sequence first = 1, last = kSequenceMax;  // both included
};

/// Beyond so many authors one pass over the log costs less than a search for each.
inline constexpr std::size_t kSearchedAuthorsMax = 256;

struct Selection {
  /// The selected edits, ascending, for each chunk that they touch and that overlaps the box.
  std::map<ChunkKey, std::vector<Sequence>> chunks;
  std::optional<VoxelBox> box;  // voxels outside do not change
  std::uint64_t edits = 0;
  Sequence first = 0, last = 0;      // of the selected edits; 0 if there are none
  TimeUs first_us = 0, last_us = 0;  // of these two edits, UTC
  std::int32_t chunk_edge = 32;
  /// Returns the smallest box around the chunks, cut to `box`, or nullopt if there are no chunks.
  std::optional<VoxelBox> area() const;
};

/// The number of pairs of chunk and edit that a selection may hold. It bounds the memory: 8 bytes
/// for each.
inline constexpr std::uint64_t kSelectionTouchesMax = 16'000'000;

/// Selects the edits of the log that match. Fails as the reader, with bad_request if the selection
/// is too large, and with cancelled once `should_continue` returns false. Cost: O(matching edits *
/// chunks that they touch).
StoreResult<Selection> select_edits(LogReader& reader, const SelectionFilter& filter,
                                    const ShouldContinue& should_continue = {});

/// Selects exactly these edits. Edits that the log does not hold are left out. Requires that
/// `edits` ascend. Fails as the reader, with bad_request if the selection is too large, and with
/// cancelled once `should_continue` returns false.
StoreResult<Selection> select_edits(LogReader& reader, const std::vector<Sequence>& edits,
                                    const ShouldContinue& should_continue = {});

}  // namespace runstone
