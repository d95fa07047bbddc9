// own_history: the newest actions of one player, read from the end of the log backwards, and the first of them
// that undo or redo would change something with. Blocks on the disk.
#pragma once
#include <optional>
#include <vector>

#include "common/generate/generator.hpp"
#include "server/rollback/own_actions.hpp"
#include "server/rollback/selection.hpp"
#include "server/store/store.hpp"

namespace runstone {

/// How many of a player's actions undo and redo look back at.
inline constexpr std::size_t kUndoActionsMax = 256;

/// The author's records up to `end`, ascending, from about the kUndoActionsMax newest actions on; not more than
/// kOwnRecordsMax. O(log of what lies between them).
inline constexpr std::size_t kOwnRecordsMax = 16'384;
StoreResult<std::vector<OwnRecord>> own_records(Store& reader, AuthorId author, Sequence end);

struct OwnChange {
  Sequence action = 0;  // the edit that is undone or redone
  Selection selection;
};
/// The undo (or redo) that is next: the first of OwnActions::undoable() (redoable()) that changes a voxel, since
/// what others have built over entirely is passed by. Nothing if there is none.
StoreResult<std::optional<OwnChange>> next_own_change(Store& reader, const Generator& generator,
                                                      AuthorId author, Cause cause, Sequence end);

}  // namespace runstone
