// own_history: the newest actions of one player, read from the end of the log backwards, and the first of them
// that undo or redo would change something with. Blocks on the disk.
#pragma once
#include <cstddef>
#include <optional>

#include "common/generate/generator.hpp"
#include "server/rollback/own_actions.hpp"
#include "server/rollback/selection.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

/// How many of a player's actions undo and redo look back at.
inline constexpr std::size_t kUndoActionsMax = 256;

/// How many of those that have nothing left to change one undo or redo passes by: each may cost a look at all the
/// chunks that it touched.
inline constexpr std::size_t kPassedActionsMax = 16;
/// What is read of the author's log at most: records, and chunks that they touch, all together.
inline constexpr std::size_t kPlayerRecordsMax = 16'384;
inline constexpr std::size_t kPlayerTouchesMax = 1'000'000;

struct PlayerChange {
  Sequence action = 0;  // the edit that is undone or redone
  Selection selection;
};
struct PlayerActionSearch {
  std::optional<PlayerChange> change;
  bool has_given_up = false;  // kPassedActionsMax were passed by, and there are more
};
/// The undo (or redo) that is next: the first of OwnActions::undoable() (redoable()) that changes a voxel, since
/// what others have built over entirely is passed by. Reads the log up to `end`, which must be durable, and reads it
/// once for all that it looks at. Fails with what the store says, and with cancelled once `goes_on` says no.
StoreResult<PlayerActionSearch> next_player_change(WorldReader& reader, const Generator& generator,
                                                   AuthorId author, Cause cause, Sequence end,
                                                   const GoesOn& goes_on = {});

}  // namespace runstone
