#include "server/rollback/player_action_search.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/rollback/restore_plan.hpp"

namespace runstone {
namespace {

constexpr std::size_t kKeptBytesMax = 64ULL << 20;
constexpr std::size_t kQueriesMax = 64;

/// The records of a player, without their edits.
struct PlayerLog {
  PlayerRanges ranges;
  Epoch newest_epoch = 0;  // of the newest record; 0 if there is none
};

/// Returns the author's records up to `end`: those of the kUndoActionsMax newest actions, and the first
/// edits of all actions that have one among them.
StoreResult<PlayerLog> player_log(LogReader& reader, AuthorId author, Sequence end,
                                  const ShouldContinue& should_continue) {
  PlayerLog log;
  PlayerRanges& ranges = log.ranges;  // the newest one is first, until the end
  std::set<Sequence> wanted;          // first edits of actions, which are further back
  std::size_t actions = 0;
  bool is_wanted = true;
  const auto read = reader.rows_of_author(author, end, [&](const LogRow& row) {
    is_wanted = !should_continue || should_continue();
    if (!is_wanted) return false;
    const Sequence seq = row.version.seq;
    if (log.newest_epoch == 0) log.newest_epoch = row.version.epoch;
    const bool continues = !ranges.empty() && row.subject != 0 &&
                           ranges.back().cause == row.cause && ranges.back().subject == row.subject;
    if (continues) {
      ranges.back().first = seq;
    } else {
      ranges.push_back({seq, seq, row.cause, row.subject});
    }
    if (row.cause == Cause::player) {
      if (row.subject != 0 && !continues) wanted.insert(row.subject);
      if (row.subject == 0) {
        ++actions;
        wanted.erase(seq);
      }
    }
    const bool is_enough = actions >= kUndoActionsMax && wanted.empty();
    return !is_enough && ranges.size() < kPlayerRangesMax;
  });
  if (!read) return failure(read.error());
  if (!is_wanted) return cancelled(reader);
  std::reverse(ranges.begin(), ranges.end());
  return log;
}

/// Collects the selection of an undo or redo, by chunk.
class PlayerSelection {
 public:
  PlayerSelection(LogReader& reader, AuthorId author, const ShouldContinue& should_continue)
      : reader_(reader), author_(author), should_continue_(should_continue) {
    selection_.chunk_edge = reader.meta().chunk_edge;
  }

  /// Selects the records of these ranges in all chunks that they touch.
  StoreResult<void> add_core(const PlayerRanges& core) {
    const auto take = [this](const ChunkKey& key, Sequence seq) {
      selection_.chunks[key].push_back(seq);
      return true;
    };
    // Of an action with many others between its edits, one query reads these, too.
    const std::size_t step = core.size() <= kQueriesMax ? 1 : core.size();
    for (std::size_t i = 0; i < core.size(); i += step) {
      LogQuery query;
      query.first = core[i].first;
      query.last = core[i + step - 1].last;
      if (const auto added = add(query, core, take); !added) return added;
    }
    return {};
  }
  /// Selects the records of these ranges in the chunks of the core. Others only decide which writers
  /// of a voxel count.
  StoreResult<void> add_others(const PlayerRanges& others) {
    const std::optional<VoxelBox> area = selection_.area();
    if (others.empty() || !area) return {};
    LogQuery query;
    query.first = others.front().first;
    query.last = others.back().last;
    query.box = area;
    const auto added = add(query, others, [this](const ChunkKey& key, Sequence seq) {
      const auto chunk = selection_.chunks.find(key);
      if (chunk != selection_.chunks.end()) chunk->second.push_back(seq);
      return chunk != selection_.chunks.end();
    });
    if (!added) return added;
    for (auto& [key, edits] : selection_.chunks) std::sort(edits.begin(), edits.end());
    return {};
  }
  Selection take() { return std::move(selection_); }

 private:
  static bool has(const PlayerRanges& ranges, Sequence seq) {
    const auto behind =
        std::upper_bound(ranges.begin(), ranges.end(), seq,
                         [](Sequence s, const PlayerRange& range) { return s < range.first; });
    return behind != ranges.begin() && seq <= std::prev(behind)->last;
  }
  /// Calls `take` for each chunk that a record of the query and the ranges touches.
  template <class Take>
  StoreResult<void> add(LogQuery& query, const PlayerRanges& ranges, const Take& take) {
    query.author = author_;
    bool is_wanted = true, has_room = true;
    std::vector<ChunkCoord> touched;
    const auto read = reader_.query_log(query, [&](const EditRecord& record) {
      is_wanted = !should_continue_ || should_continue_();
      if (!is_wanted || !has(ranges, record.version.seq)) return is_wanted;
      touched_chunks(record.edit, selection_.chunk_edge, touched);
      bool is_inside = false;
      for (const ChunkCoord at : touched)
        if (take(ChunkKey{0, at}, record.version.seq)) {
          is_inside = true;
          ++touches_;
        }
      if (is_inside) note(record);
      has_room = touches_ <= kSelectionTouchesMax;
      return has_room;
    });
    if (!read) return failure(read.error());
    if (!is_wanted) return cancelled(reader_);
    if (!has_room) {
      return failure(StoreError{StoreError::Kind::bad_request, reader_.file(), "edit_log",
                                "the action touches chunks " +
                                    std::to_string(kSelectionTouchesMax) +
                                    " times or more: ask an operator to roll it back in parts"});
    }
    return {};
  }
  void note(const EditRecord& record) {
    const Sequence seq = record.version.seq;
    if (selection_.edits++ == 0 || seq < selection_.first) {
      selection_.first = seq;
      selection_.first_us = record.time_us;
    }
    if (seq > selection_.last) {
      selection_.last = seq;
      selection_.last_us = record.time_us;
    }
  }

  LogReader& reader_;
  const AuthorId author_;
  const ShouldContinue& should_continue_;
  Selection selection_;
  std::uint64_t touches_ = 0;
};

/// Returns the ranges of `all` that are not in `core`. Both ascend.
PlayerRanges without(const PlayerRanges& all, const PlayerRanges& core) {
  PlayerRanges out;
  std::set_difference(all.begin(), all.end(), core.begin(), core.end(), std::back_inserter(out),
                      [](const PlayerRange& a, const PlayerRange& b) { return a.first < b.first; });
  return out;
}

}  // namespace

StoreResult<PlayerActionSearch> next_player_change(WorldReader& reader, const Generator& generator,
                                                   AuthorId author, Cause cause, Sequence end,
                                                   Epoch epoch,
                                                   const ShouldContinue& should_continue) {
  RUNSTONE_ASSERT(cause == Cause::undo || cause == Cause::redo);
  const auto log = player_log(reader, author, end, should_continue);
  if (!log) return failure(log.error());
  const PlayerActions actions(log->ranges);
  const bool is_undo = cause == Cause::undo;
  std::vector<Sequence> candidates = is_undo ? actions.undoable() : actions.redoable();
  PlayerActionSearch search;
  search.has_given_up = candidates.size() > kPassedActionsMax;
  if (search.has_given_up) candidates.resize(kPassedActionsMax);
  if (const auto toggled = actions.newest_toggled(cause); toggled && log->newest_epoch < epoch)
    candidates.insert(candidates.begin(), *toggled);
  RestorePlanner planner(reader, generator, should_continue, kKeptBytesMax);
  for (const Sequence action : candidates) {
    const PlayerRanges core = is_undo ? actions.undo_core(action) : actions.redo_core(action);
    const PlayerRanges all = is_undo ? actions.to_undo(action) : actions.to_redo(action);
    PlayerSelection selected(reader, author, should_continue);
    if (const auto added = selected.add_core(core); !added) return failure(added.error());
    if (const auto added = selected.add_others(without(all, core)); !added)
      return failure(added.error());
    Selection selection = selected.take();
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
