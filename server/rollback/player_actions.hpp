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

/// Records of the player from `first` to `last` that have one cause and one subject. The player has
/// no other record between them, but others may. So an action of any number of edits is few ranges. An
/// edit that begins an action is a range by itself.
struct PlayerRange {
  Sequence first = 0, last = 0;
  Cause cause = Cause::player;
  Sequence subject = 0;
  friend bool operator==(const PlayerRange&, const PlayerRange&) = default;
};
/// Ascending, without overlaps.
using PlayerRanges = std::vector<PlayerRange>;

struct PlayerAction {
  Sequence seq = 0;    // of its first edit
  PlayerRanges edits;  // all of them
  PlayerRanges toggles;
  // The toggles of the undo in force; empty unless the action is undone.
  PlayerRanges last_undo;
  // The toggles of the last redo, and of the undo that it took back; empty if the action is undone.
  PlayerRanges last_redo;
  bool is_undone() const { return !last_undo.empty(); }
};

class PlayerActions {
 public:
  /// Takes the player's records. Other causes are ignored. The records may begin
  /// anywhere in the log: an edit or a toggle is ignored if its subject is not among them. Such a
  /// subject is an older action, or a rollback that the player undid as operator.
  explicit PlayerActions(std::span<const PlayerRange> records);

  /// Returns the actions that may be undone, newest first.
  std::vector<Sequence> undoable() const;
  /// Returns the actions that may be redone. The action that was undone last comes first.
  std::vector<Sequence> redoable() const;

  /// Returns the action if the player's newest record is a toggle of it with this cause. If the
  /// server ended meanwhile, that undo or redo may be unfinished, and to_undo() or to_redo() of the
  /// action finishes it.
  std::optional<Sequence> newest_toggled(Cause cause) const;

  /// Returns the edits that undo of an action selects. Requires an action of undoable(), or
  /// newest_toggled(Cause::undo).
  PlayerRanges to_undo(Sequence action) const;
  /// Returns the edits that redo of an action selects. Requires an action of redoable(), or
  /// newest_toggled(Cause::redo).
  PlayerRanges to_redo(Sequence action) const;
  /// Return the records of the action itself in to_undo() and to_redo(). All changes lie in the
  /// chunks that they touch.
  PlayerRanges undo_core(Sequence action) const;
  PlayerRanges redo_core(Sequence action) const;

 private:
  const PlayerAction& find(Sequence action) const;
  void others(Sequence but, PlayerRanges& out) const;
  std::vector<PlayerAction> actions_;  // by sequence
  Sequence last_action_ = 0;
  std::optional<PlayerRange> newest_toggle_;  // if no action is newer
};

}  // namespace runstone
