// Player action search: finds the action that a player's next undo or redo takes, the first one for
// which it changes a voxel. It reads the player's newest actions from the end of the log backwards.
// It blocks on the disk.
#pragma once
#include <cstddef>
#include <optional>

#include "common/generate/generator.hpp"
#include "server/rollback/player_actions.hpp"
#include "server/rollback/selection.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

/// The number of a player's newest actions that undo and redo consider.
inline constexpr std::size_t kUndoActionsMax = 256;

/// The number of actions without effect that one undo or redo skips. Each may cost a plan for every
/// chunk that the action touched.
inline constexpr std::size_t kPassedActionsMax = 16;
/// Bounds of what is read of the author's log: records, and chunks that they touch, counted once
/// for each record.
inline constexpr std::size_t kPlayerRecordsMax = 16'384;
inline constexpr std::size_t kPlayerTouchesMax = 1'000'000;

struct PlayerChange {
  Sequence action = 0;  // the edit that is undone or redone
  Selection selection;
};
struct PlayerActionSearch {
  std::optional<PlayerChange> change;
  bool has_given_up = false;  // kPassedActionsMax actions were skipped, and there are more
};
/// Returns the next undo (or redo): the first of PlayerActions::undoable() (redoable()) that
/// changes a voxel. An action is skipped if others have built over all of it. Reads the log once,
/// up to `end`. Requires that `end` is durable. Fails as the reader, and with cancelled once
/// `should_continue` returns false.
StoreResult<PlayerActionSearch> next_player_change(WorldReader& reader, const Generator& generator,
                                                   AuthorId author, Cause cause, Sequence end,
                                                   const ShouldContinue& should_continue = {});

}  // namespace runstone
