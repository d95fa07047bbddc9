// OwnActions: what one player did, undid and did again, as the log tells it; there is no other state. An
// *action* is an edit with cause player. A *toggle* is an undo or redo: records of the player with that cause
// whose subject is the action, one per chunk. An action is undone if its last toggle is an undo.
// Undo takes back the newest action that is not undone; redo the one undone last, unless the player has done
// something new since. What counts as "the player's tail" of a voxel then (common/edits/restore/restore.hpp):
//   - all records of the action itself;
//   - all records of the player's other actions that are undone, as if they had never been;
//   - of the player's other actions that stand, only their toggles, which cancel each other out. Otherwise an
//     undo and redo of a later action would hide an earlier one from undo for ever.
// Pure.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "common/core/ids.hpp"

namespace runstone {

/// One record of the player, in short.
struct PlayerRecord {
  Sequence seq = 0;
  Cause cause = Cause::player;
  Sequence subject = 0;
};

struct PlayerAction {
  Sequence seq = 0;               // of the edit
  std::vector<Sequence> toggles;  // ascending
  std::vector<Sequence>
      last_undo;  // the toggles of the undo that stands; empty unless it is undone
  bool is_undone() const { return !last_undo.empty(); }
};

class PlayerActions {
 public:
  /// The player's records, ascending; other causes are ignored. They may begin anywhere in the log: toggles of
  /// what is not among them (an older action, or a rollback that the player undid as operator) are ignored too.
  explicit PlayerActions(std::span<const PlayerRecord> records);

  /// Actions that may be undone, newest first; that may be redone, undone last first.
  std::vector<Sequence> undoable() const;
  std::vector<Sequence> redoable() const;

  /// The edits that undo of the action selects, ascending. Requires one of undoable().
  std::vector<Sequence> to_undo(Sequence action) const;
  /// The same for redo. Requires one of redoable().
  std::vector<Sequence> to_redo(Sequence action) const;
  /// The records that stand for the action itself in to_undo() or to_redo(): what is changed lies in the
  /// chunks they touch.
  std::vector<Sequence> undo_core(Sequence action) const;
  std::vector<Sequence> redo_core(Sequence action) const;

 private:
  const PlayerAction& find(Sequence action) const;
  void others(Sequence but, std::vector<Sequence>& out) const;
  std::vector<PlayerAction> actions_;  // by sequence
  Sequence last_action_ = 0;
};

}  // namespace runstone
