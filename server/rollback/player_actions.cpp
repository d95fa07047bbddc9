#include "server/rollback/player_actions.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

void sort_ranges(PlayerRanges& ranges) {
  std::sort(ranges.begin(), ranges.end(),
            [](const PlayerRange& a, const PlayerRange& b) { return a.first < b.first; });
}

}  // namespace

PlayerActions::PlayerActions(std::span<const PlayerRange> records) {
  std::map<Sequence, PlayerAction> by_edit;
  for (const PlayerRange& range : records) {
    if (range.cause == Cause::player) {
      const Sequence first = range.subject != 0 ? range.subject : range.first;
      last_action_ = range.last;
      newest_toggle_.reset();
      if (first != range.first && !by_edit.contains(first)) continue;
      PlayerAction& action = by_edit[first];
      action.seq = first;
      action.edits.push_back(range);
      continue;
    }
    if (range.cause != Cause::undo && range.cause != Cause::redo) continue;
    const auto found = by_edit.find(range.subject);
    if (found == by_edit.end()) continue;
    PlayerAction& action = found->second;
    action.toggles.push_back(range);
    newest_toggle_ = range;
    if (range.cause == Cause::undo) {
      action.last_undo.push_back(range);
      action.last_redo.clear();
    } else {
      if (!action.last_undo.empty()) action.last_redo = std::exchange(action.last_undo, {});
      action.last_redo.push_back(range);
    }
  }
  for (auto& [seq, action] : by_edit) actions_.push_back(std::move(action));
}

std::optional<Sequence> PlayerActions::newest_toggled(Cause cause) const {
  if (!newest_toggle_ || newest_toggle_->cause != cause) return std::nullopt;
  return newest_toggle_->subject;
}

std::vector<Sequence> PlayerActions::undoable() const {
  std::vector<Sequence> out;
  for (auto action = actions_.rbegin(); action != actions_.rend(); ++action) {
    if (!action->is_undone()) out.push_back(action->seq);
  }
  return out;
}

std::vector<Sequence> PlayerActions::redoable() const {
  std::vector<const PlayerAction*> undone;
  for (const PlayerAction& action : actions_) {
    if (action.is_undone() && action.last_undo.back().last > last_action_)
      undone.push_back(&action);
  }
  std::sort(undone.begin(), undone.end(), [](const PlayerAction* a, const PlayerAction* b) {
    return a->last_undo.back().last > b->last_undo.back().last;
  });
  std::vector<Sequence> out;
  out.reserve(undone.size());
  for (const PlayerAction* action : undone) out.push_back(action->seq);
  return out;
}

const PlayerAction& PlayerActions::find(Sequence action) const {
  const auto found =
      std::lower_bound(actions_.begin(), actions_.end(), action,
                       [](const PlayerAction& a, Sequence seq) { return a.seq < seq; });
  RUNSTONE_ASSERT(found != actions_.end() && found->seq == action);
  return *found;
}

void PlayerActions::others(Sequence but, PlayerRanges& out) const {
  for (const PlayerAction& action : actions_) {
    if (action.seq == but) continue;
    if (action.is_undone()) out.insert(out.end(), action.edits.begin(), action.edits.end());
    out.insert(out.end(), action.toggles.begin(), action.toggles.end());
  }
  sort_ranges(out);
}

PlayerRanges PlayerActions::undo_core(Sequence action) const {
  const PlayerAction& mine = find(action);
  PlayerRanges out = mine.edits;
  out.insert(out.end(), mine.toggles.begin(), mine.toggles.end());
  sort_ranges(out);
  return out;
}

PlayerRanges PlayerActions::redo_core(Sequence action) const {
  const PlayerAction& mine = find(action);
  return mine.is_undone() ? mine.last_undo : mine.last_redo;
}

PlayerRanges PlayerActions::to_undo(Sequence action) const {
  PlayerRanges out = undo_core(action);
  others(action, out);
  return out;
}

PlayerRanges PlayerActions::to_redo(Sequence action) const {
  PlayerRanges out = redo_core(action);
  others(action, out);
  return out;
}

}  // namespace runstone
