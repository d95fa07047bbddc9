#include "server/rollback/rollback_preview.hpp"

#include "common/core/key_text.hpp"
#include "common/core/utc_text.hpp"
#include "server/rollback/count_text.hpp"
#include "server/store/removed_history.hpp"

namespace runstone {
namespace {

/// Returns a box as commands take it: both corners are inside.
std::string text_of_box(const VoxelBox& box) {
  return text_of(box.min) + " to " + text_of(VoxelPos{box.max.x - 1, box.max.y - 1, box.max.z - 1});
}

}  // namespace

void RollbackPreview::compute(WorldReader& reader, const Generator& generator,
                              const SelectionFilter& filter, Sequence end, const PlanViewer& viewer,
                              const Summary& summarise) {
  const auto should_continue = [this] { return is_wanted->load(); };
  const auto head = reader.log_head();
  if (!head) return fail_with(head.error());
  if (filter.first <= head->version.seq && filter.from_us <= head->time_us)
    removed = "older edits were " + removed_up_to(*head) + ": they stay as they are";
  auto selected = select_edits(reader, filter, should_continue);
  if (!selected) return fail_with(selected.error());
  selection = std::make_shared<const Selection>(*std::move(selected));
  std::vector<RestorePlanner::Item> items;
  items.reserve(selection->chunks.size());
  for (const auto& [key, edits] : selection->chunks) items.push_back({key, edits});
  progress->edits.store(selection->edits);
  progress->chunks.store(items.size());
  RestorePlanner planner(reader, generator, should_continue);
  std::vector<ChunkKey> changing;
  planner.count_all(items, selection->box, end,
                    [&](const ChunkKey& key, const StoreResult<std::uint64_t>& count) {
                      if (!count) {
                        fail_with(count.error());
                        return false;
                      }
                      ++progress->chunks_done;
                      voxels += *count;
                      chunks += *count > 0 ? 1 : 0;
                      if (viewer.choose && *count > 0) changing.push_back(key);
                      return true;
                    });
  if (!error.empty() || voxels == 0) return;
  if (viewer.choose) show(planner, end, changing, viewer);
  if (error.empty() && summarise) summary = summarise(reader, generator, id(), should_continue);
}

void RollbackPreview::show(RestorePlanner& planner, Sequence end,
                           const std::vector<ChunkKey>& changing, const PlanViewer& viewer) {
  std::vector<RestorePlanner::Item> items;
  for (const ChunkKey& key : viewer.choose(changing))
    items.push_back({key, selection->chunks.at(key)});
  planner.plan_all(items, selection->box, end,
                   [&](const ChunkKey&, const StoreResult<RestorePlan>& plan) {
                     if (plan) {
                       viewer.add(*plan);
                     } else {
                       fail_with(plan.error());
                     }
                     return plan.has_value();
                   });
}

std::string RollbackPreview::progress_text() const {
  const std::uint64_t chunks_all = progress->chunks.load();
  if (chunks_all == 0) return "looking for the edits";
  return counted(progress->edits.load(), "edit") + ", " +
         std::to_string(progress->chunks_done.load()) + " of " + counted(chunks_all, "chunk");
}

std::string RollbackPreview::text_of_nothing() const {
  const std::string why = selection->edits == 0
                              ? "no edit matches"
                              : counted(selection->edits, "edit") +
                                    " match, but nothing of them is left: others have built there, "
                                    "or it was taken back before";
  return "rollback preview: nothing to do: " + why + (removed.empty() ? "" : "\n" + removed);
}

std::string RollbackPreview::text() const {
  const Selection& s = *selection;
  std::string text = "preview " + id() + ": would take back " + counted(s.edits, "edit") + " (" +
                     utc_text(s.first_us) + " to " + utc_text(s.last_us) +
                     "): " + counted(voxels, "voxel") + " in " + counted(chunks, "chunk") +
                     " would change\n";
  text += "area " + text_of_box(*s.area()) + "\n";
  if (!removed.empty()) text += removed + "\n";
  if (!summary.empty()) text += summary + "\n";
  text += "nothing has changed yet: `rollback apply " + id() + "` does it, `rollback cancel " +
          id() + "` forgets it";
  return text;
}

}  // namespace runstone
