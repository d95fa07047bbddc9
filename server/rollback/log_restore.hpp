// LogRestore: a restore that follows the log of its chunk. It finds the selected records, and the
// points to which records return that take a rollback back. Restore is ChunkRestore or VoxelRestore.
// Thread: one.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>

#include "common/core/ids.hpp"
#include "common/edits/apply/apply_scratch.hpp"
#include "common/edits/descriptor/edit_record.hpp"

namespace runstone {

template <class Restore>
class LogRestore {
 public:
  /// `selected` ascend, at least one, and must outlive the object.
  LogRestore(Restore restore, std::span<const Sequence> selected)
      : restore_(std::move(restore)), selected_(selected), next_(selected.begin()) {}

  /// Adds the next record that touches the chunk.
  void add(const EditRecord& record, ApplyScratch& scratch) {
    while (next_ != selected_.end() && *next_ < record.version.seq) ++next_;
    const bool is_selected = next_ != selected_.end() && *next_ == record.version.seq;
    if (is_selected) {
      ++edits_;
      subject_ = record.version.seq;
    }
    const typename Restore::Point* const target = is_selected ? nullptr : target_of(record);
    if (record.version.seq >= selected_.front()) keep_point(record, scratch);
    if (target != nullptr) {
      restore_.add_return(record.edit, *target, scratch);
    } else {
      restore_.add(record.edit, is_selected, scratch);
    }
    // Only now, because it may be the target.
    if (points_.size() > kPointsMax) points_.erase(points_.begin());
  }

  Restore& restore() { return restore_; }
  /// Returns the number of selected records so far, and the newest of them or 0.
  std::uint64_t edits() const { return edits_; }
  Sequence subject() const { return subject_; }

 private:
  // Of a chunk that was rolled back more often, the oldest rollbacks are edits like others.
  static constexpr std::size_t kPointsMax = 64;

  /// Returns the point to which the record returns, or null: its subject is no rollback whose point
  /// is kept.
  const typename Restore::Point* target_of(const EditRecord& record) const {
    const auto group = group_of_.find(record.subject);
    if (group == group_of_.end()) return nullptr;
    const auto point = points_.find(group->second);
    return point == points_.end() ? nullptr : &point->second;
  }
  /// Keeps the point before the record if it begins a rollback in this chunk, or an undo of one.
  void keep_point(const EditRecord& record, ApplyScratch& scratch) {
    const bool is_rollback = record.cause == Cause::rollback;
    const bool is_undo = record.cause == Cause::undo && group_of_.contains(record.subject);
    if (!is_rollback && !is_undo) return;
    const auto first =
        first_of_.try_emplace({record.op.author, record.op.instance}, record.version.seq);
    group_of_[record.version.seq] = first.first->second;
    if (!first.second) return;
    points_.emplace(record.version.seq, restore_.point(scratch));
  }

  Restore restore_;
  std::span<const Sequence> selected_;
  std::span<const Sequence>::iterator next_;
  std::uint64_t edits_ = 0;
  Sequence subject_ = 0;
  // The points before each rollback, and before each undo of one.
  std::map<std::pair<AuthorId, ClientInstance>, Sequence> first_of_;  // in this chunk
  std::map<Sequence, Sequence> group_of_;                             // first edit, by edit
  std::map<Sequence, typename Restore::Point> points_;                // by first edit
};

}  // namespace runstone
