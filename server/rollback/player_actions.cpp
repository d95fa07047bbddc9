#include "server/rollback/player_actions.hpp"

#include <algorithm>
#include <map>

#include "common/core/assert.hpp"

namespace runstone {

PlayerActions::PlayerActions(std::span<const PlayerRecord> records) {
  std::map<Sequence, PlayerAction> by_edit;
  for (const PlayerRecord& record : records) {
    if (record.cause == Cause::player) {
      const Sequence first = record.subject != 0 ? record.subject : record.seq;
      last_action_ = record.seq;
      if (first != record.seq && !by_edit.contains(first)) continue;
      PlayerAction& action = by_edit[first];
      action.seq = first;
      action.edits.push_back(record.seq);
      continue;
    }
    if (record.cause != Cause::undo && record.cause != Cause::redo) continue;
    const auto found = by_edit.find(record.subject);
    if (found == by_edit.end()) continue;
    PlayerAction& action = found->second;
    action.toggles.push_back(record.seq);
    if (record.cause == Cause::undo) {
      action.last_undo.push_back(record.seq);
    } else {
      action.last_undo.clear();
    }
  }
  for (auto& [seq, action] : by_edit) actions_.push_back(std::move(action));
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
    if (action.is_undone() && action.last_undo.back() > last_action_) undone.push_back(&action);
  }
  std::sort(undone.begin(), undone.end(), [](const PlayerAction* a, const PlayerAction* b) {
    return a->last_undo.back() > b->last_undo.back();
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

void PlayerActions::others(Sequence but, std::vector<Sequence>& out) const {
  for (const PlayerAction& action : actions_) {
    if (action.seq == but) continue;
    if (action.is_undone()) out.insert(out.end(), action.edits.begin(), action.edits.end());
    out.insert(out.end(), action.toggles.begin(), action.toggles.end());
  }
  std::sort(out.begin(), out.end());
}

std::vector<Sequence> PlayerActions::undo_core(Sequence action) const {
  const PlayerAction& mine = find(action);
  std::vector<Sequence> out = mine.edits;
  out.insert(out.end(), mine.toggles.begin(), mine.toggles.end());
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<Sequence> PlayerActions::redo_core(Sequence action) const {
  return find(action).last_undo;
}

std::vector<Sequence> PlayerActions::to_undo(Sequence action) const {
  std::vector<Sequence> out = undo_core(action);
  others(action, out);
  return out;
}

std::vector<Sequence> PlayerActions::to_redo(Sequence action) const {
  std::vector<Sequence> out = redo_core(action);
  others(action, out);
  return out;
}

}  // namespace runstone
