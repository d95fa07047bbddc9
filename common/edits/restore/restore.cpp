#include "common/edits/restore/restore.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"
#include "common/edits/apply/edit_changes.hpp"
#include "common/edits/apply/replayed_chunk.hpp"

namespace runstone {

void append_differences(const RunChunk& now, const RunChunk& restored,
                        std::vector<Difference>& out) {
  RUNSTONE_ASSERT(now.extent == restored.extent && now.order == restored.order);
  const std::size_t start = out.size();
  std::size_t i = 0, j = 0;
  for (VoxelIndex at = 0; at < now.volume();) {
    const Run a = now.runs[i];
    const Run b = restored.runs[j];
    const VoxelIndex end = std::min(a.end, b.end);
    if (a.material != b.material) {
      const bool joins = out.size() > start && out.back().last == at &&
                         out.back().now == a.material && out.back().restored == b.material;
      if (joins) {
        out.back().last = end;
      } else {
        out.push_back({at, end, a.material, b.material});
      }
    }
    i += a.end == end ? 1 : 0;
    j += b.end == end ? 1 : 0;
    at = end;
  }
}

ChunkRestore::ChunkRestore(RunChunk before, VoxelPos origin)
    : origin_(origin), now_(std::move(before)) {}

void ChunkRestore::add(const EditDescriptor& edit, bool is_selected, ApplyScratch& scratch) {
  // Once the chunks differ, two edits that are not selected may not be applied in one sweep. The
  // second might revert what the first wrote over a selected edit, and the sweep would report no
  // writer at all.
  const bool may_join = pending_.empty() || pending_is_selected_ == is_selected;
  if (!may_join || pending_.size() == kReplayStackMax) flush(scratch);
  if (is_split_ && !is_selected) return apply({&edit, 1}, false, scratch);
  pending_.push_back(edit);
  pending_is_selected_ = is_selected;
}

RestorePoint ChunkRestore::point(ApplyScratch& scratch) {
  flush(scratch);
  return {now(), restored()};
}

void ChunkRestore::add_return(const EditDescriptor& edit, const RestorePoint& before,
                              ApplyScratch& scratch) {
  flush(scratch);
  if (!is_split_) restored_ = now_;
  apply_stack(now_, digest_, origin_, {&edit, 1}, scratch, result_);
  if (!result_.changed) return;
  std::vector<Change> changes;
  std::size_t i = 0, j = 0;
  for (const Change& change : changes_of(scratch, result_)) {
    for (VoxelIndex at = change.first; at < change.last;) {
      while (before.now.runs[i].end <= at) ++i;
      while (before.restored.runs[j].end <= at) ++j;
      const Run then = before.now.runs[i], without = before.restored.runs[j];
      const VoxelIndex last = std::min({change.last, then.end, without.end});
      const bool returns = then.material == change.material;
      changes.push_back({at, last, returns ? without.material : change.material});
      at = last;
    }
  }
  write_changes(restored_, changes, scratch);
  is_split_ = now_.runs != restored_.runs;
}

void ChunkRestore::flush(ApplyScratch& scratch) {
  if (pending_.empty()) return;
  apply(pending_, pending_is_selected_, scratch);
  pending_.clear();
}

void ChunkRestore::apply(std::span<const EditDescriptor> edits, bool is_selected,
                         ApplyScratch& scratch) {
  if (is_selected && !is_split_) restored_ = now_;
  apply_stack(now_, digest_, origin_, edits, scratch, result_);
  if (!result_.changed) return;
  if (is_split_ && !is_selected) write_changes(restored_, changes_of(scratch, result_), scratch);
  // The axis order is the same and the runs are canonical, so equal voxels have equal runs.
  if (is_selected || is_split_) is_split_ = now_.runs != restored_.runs;
}

}  // namespace runstone
