// PlayerActions: what one player did, undid and redid. The log is the only state. An *action* is
// one or more edits with cause player: those after the first one have it as their subject. It is
// undone and redone as a whole. A *toggle* is an undo or redo: records of the player with that
// cause whose subject is the action, one for each chunk. An action is undone if its last toggle is
// an undo. Undo takes the newest action that is not undone. Redo takes the action that was undone
// last, unless the player has done a new action since. Both select edits of the player, and
// common/edits/restore/restore.hpp defines the effect:
//   - all records of the action itself;
//   - all records of the player's other actions that are undone, as if these actions had never
//     been;
//   - of the player's other actions that stand, only their toggles, which cancel each other out.
//     Without them, an undo and redo of a later action would hide an earlier one from undo for
//     ever.
// Pure: it reads no log and no clock.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "common/core/ids.hpp"

namespace runstone {

/// The fields of a record that matter here.
struct PlayerRecord {
  Sequence seq = 0;
  Cause cause = Cause::player;
  Sequence subject = 0;
};

struct PlayerAction {
  Sequence seq = 0;               // of its first edit
  std::vector<Sequence> edits;    // all of them, ascending
  std::vector<Sequence> toggles;  // ascending
  // The toggles of the undo in force; empty unless the action is undone.
  std::vector<Sequence> last_undo;
  bool is_undone() const { return !last_undo.empty(); }
};

class PlayerActions {
 public:
  /// Takes the player's records, ascending. Other causes are ignored. The records may begin
  /// anywhere in the log: an edit or a toggle is ignored if its subject is not among them. Such a
  /// subject is an older action, or a rollback that the player undid as operator.
  explicit PlayerActions(std::span<const PlayerRecord> records);

  /// Returns the actions that may be undone, newest first.
  std::vector<Sequence> undoable() const;
  /// Returns the actions that may be redone. The action that was undone last comes first.
  std::vector<Sequence> redoable() const;

  /// Returns the edits that undo of an action selects, ascending. Requires an action of undoable().
  std::vector<Sequence> to_undo(Sequence action) const;
  /// Returns the edits that redo of an action selects, ascending. Requires an action of redoable().
  std::vector<Sequence> to_redo(Sequence action) const;
  /// Return the records of the action itself, ascending, in to_undo() and to_redo(). All changes
  /// lie in the chunks that they touch.
  std::vector<Sequence> undo_core(Sequence action) const;
  std::vector<Sequence> redo_core(Sequence action) const;

 private:
  const PlayerAction& find(Sequence action) const;
  void others(Sequence but, std::vector<Sequence>& out) const;
  std::vector<PlayerAction> actions_;  // by sequence
  Sequence last_action_ = 0;
};

}  // namespace runstone
