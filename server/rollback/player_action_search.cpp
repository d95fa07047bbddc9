#include "server/rollback/player_action_search.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/rollback/restore_plan.hpp"

namespace runstone {
namespace {

constexpr Sequence kFirstWindow = 4096;
constexpr std::size_t kKeptBytesMax = 64ULL << 20;

/// One record of the player, and the chunks that it touched.
struct PlayerEdit {
  PlayerRecord record;
  TimeUs time_us = 0;
  std::vector<ChunkCoord> chunks;
};

/// Returns the author's records up to `end`, ascending: about those of the kUndoActionsMax newest
/// actions.
StoreResult<std::vector<PlayerEdit>> player_edits(WorldReader& reader, AuthorId author,
                                                  Sequence end,
                                                  const ShouldContinue& should_continue) {
  // The index can be read only in ascending order. The log is therefore read in windows from its
  // end, each twice as wide as the one before. If a window has too many records, half of it is read
  // instead.
  const std::int32_t edge = reader.meta().chunk_edge;
  std::vector<PlayerEdit> newest;
  std::size_t actions = 0, touches = 0;
  const auto is_enough = [&] {
    return actions >= kUndoActionsMax || newest.size() >= kPlayerRecordsMax ||
           touches >= kPlayerTouchesMax;
  };
  Sequence width = kFirstWindow;
  for (Sequence last = end; last > 0 && !is_enough();) {
    const Sequence first = last > width ? last - width + 1 : 1;
    LogQuery query;
    query.author = author;
    query.first = first;
    query.last = last;
    std::vector<PlayerEdit> window;
    std::size_t window_touches = 0;
    bool is_wanted = true;
    const auto is_too_much = [&] {
      return window.size() > kPlayerRecordsMax || window_touches > kPlayerTouchesMax;
    };
    const auto read = reader.query_log(query, [&](const EditRecord& record) {
      is_wanted = !should_continue || should_continue();
      if (!is_wanted) return false;
      window.push_back({{record.version.seq, record.cause, record.subject},
                        record.time_us,
                        touched_chunks(record.edit, edge)});
      window_touches += window.back().chunks.size();
      return !is_too_much();
    });
    if (!read) return failure(read.error());
    if (!is_wanted) return cancelled(reader);
    if (is_too_much() && first < last) {
      width = (last - first + 1) / 2;
      continue;
    }
    for (const PlayerEdit& edit : window) {
      const PlayerRecord& record = edit.record;
      actions += record.cause == Cause::player && record.subject == 0 ? 1 : 0;
    }
    touches += window_touches;
    std::move(newest.begin(), newest.end(), std::back_inserter(window));
    newest = std::move(window);
    last = first - 1;
    width *= 2;
  }
  return newest;
}

/// Returns the selection of `edits` by chunk. It holds only chunks that edits of `core` touch: all
/// voxels to be changed lie there. The other edits only decide which writers of a voxel count.
/// Requires that both ascend.
Selection selection_of(const std::vector<PlayerEdit>& edited, const std::vector<Sequence>& edits,
                       const std::vector<Sequence>& core, std::int32_t edge) {
  const auto find = [&](Sequence seq) -> const PlayerEdit& {
    const auto found =
        std::lower_bound(edited.begin(), edited.end(), seq,
                         [](const PlayerEdit& e, Sequence s) { return e.record.seq < s; });
    RUNSTONE_ASSERT(found != edited.end() && found->record.seq == seq);
    return *found;
  };
  Selection selection;
  selection.chunk_edge = edge;
  for (const Sequence seq : core) {
    for (const ChunkCoord at : find(seq).chunks) selection.chunks[{0, at}];
  }
  for (const Sequence seq : edits) {
    const PlayerEdit& edit = find(seq);
    for (const ChunkCoord at : edit.chunks) {
      const auto chunk = selection.chunks.find({0, at});
      if (chunk != selection.chunks.end()) chunk->second.push_back(seq);
    }
    if (selection.edits++ == 0) {
      selection.first = seq;
      selection.first_us = edit.time_us;
    }
    selection.last = seq;
    selection.last_us = edit.time_us;
  }
  return selection;
}

}  // namespace

StoreResult<PlayerActionSearch> next_player_change(WorldReader& reader, const Generator& generator,
                                                   AuthorId author, Cause cause, Sequence end,
                                                   const ShouldContinue& should_continue) {
  RUNSTONE_ASSERT(cause == Cause::undo || cause == Cause::redo);
  const auto edited = player_edits(reader, author, end, should_continue);
  if (!edited) return failure(edited.error());
  std::vector<PlayerRecord> records;
  records.reserve(edited->size());
  for (const PlayerEdit& edit : *edited) records.push_back(edit.record);
  const PlayerActions actions(records);
  const bool is_undo = cause == Cause::undo;
  const std::int32_t edge = reader.meta().chunk_edge;
  std::vector<Sequence> candidates = is_undo ? actions.undoable() : actions.redoable();
  PlayerActionSearch search;
  search.has_given_up = candidates.size() > kPassedActionsMax;
  if (search.has_given_up) candidates.resize(kPassedActionsMax);
  RestorePlanner planner(reader, generator, should_continue, kKeptBytesMax);
  for (const Sequence action : candidates) {
    Selection selection =
        is_undo ? selection_of(*edited, actions.to_undo(action), actions.undo_core(action), edge)
                : selection_of(*edited, actions.to_redo(action), actions.redo_core(action), edge);
    for (const auto& [key, edits] : selection.chunks) {
      const auto plan = planner.plan(key, edits, std::nullopt, end);
      if (!plan) return failure(plan.error());
      if (plan->voxels > 0)
        return PlayerActionSearch{PlayerChange{action, std::move(selection)}, false};
    }
  }
  return search;
}

}  // namespace runstone
