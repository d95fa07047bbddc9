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
/// Bounds the memory of what is read of the author's log: ranges (PlayerRange) of 32 bytes. An action
/// may have any number of edits. What it touches is bounded by kSelectionTouchesMax.
inline constexpr std::size_t kPlayerRangesMax = 1'000'000;

struct PlayerChange {
  Sequence action = 0;  // the edit that is undone or redone
  Selection selection;
};
struct PlayerActionSearch {
  std::optional<PlayerChange> change;
  bool has_given_up = false;  // kPassedActionsMax actions were skipped, and there are more
};
/// Returns the next undo (or redo): the first of PlayerActions::undoable() (redoable()) that
/// changes a voxel. An action is skipped if others have built over all of it. If the player's newest
/// record is an undo (or redo) of an earlier epoch than `epoch`, that of this start, the server may have
/// ended in the middle of it: it comes first. Reads the log up to `end`. Requires that `end` is durable.
/// Fails as the reader, with bad_request if the action touches more than kSelectionTouchesMax chunks,
/// and with cancelled once `should_continue` returns false. Cost: O(records of the author back to the
/// first edit of the action + edits of the action).
StoreResult<PlayerActionSearch> next_player_change(WorldReader& reader, const Generator& generator,
                                                   AuthorId author, Cause cause, Sequence end,
                                                   Epoch epoch,
                                                   const ShouldContinue& should_continue = {});

}  // namespace runstone
