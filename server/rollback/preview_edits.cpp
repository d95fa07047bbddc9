#include "server/rollback/preview_edits.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "common/edits/descriptor/edit_descriptor.hpp"
#include "protocol/limits.hpp"
#include "server/rollback/restore_paste.hpp"

namespace runstone {
namespace {

std::int64_t squared(std::int64_t v) { return v * v; }

}  // namespace

std::int64_t PreviewEdits::distance_of(ChunkCoord at) const {
  return squared(std::int64_t{at.x} - view_.centre.x) +
         squared(std::int64_t{at.y} - view_.centre.y) +
         squared(std::int64_t{at.z} - view_.centre.z);
}

std::vector<ChunkKey> PreviewEdits::choose(const std::vector<ChunkKey>& changing) {
  std::vector<ChunkKey> seen;
  for (const ChunkKey& key : changing) {
    if (key.lod == 0 && view_.contains(key.at)) seen.push_back(key);
  }
  if (seen.size() <= kRestorePreviewEditsMax) return seen;
  is_cut_ = true;
  const auto end = seen.begin() + kRestorePreviewEditsMax;
  std::nth_element(seen.begin(), end, seen.end(), [this](const ChunkKey& a, const ChunkKey& b) {
    const std::int64_t to_a = distance_of(a.at), to_b = distance_of(b.at);
    return to_a != to_b ? to_a < to_b : a < b;
  });
  seen.erase(end, seen.end());
  std::sort(seen.begin(), seen.end());
  return seen;
}

void PreviewEdits::add(const RestorePlan& plan) {
  const ChunkCoord at = plan.key.at;
  if (plan.key.lod != 0 || plan.differences.empty() || !view_.contains(at)) return;
  Part part;
  part.at = at;
  part.distance = distance_of(at);
  part.edits =
      restore_pastes(plan.now, plan.differences, origin_of(at, plan.now.extent.sides()[0]));
  for (const EditDescriptor& edit : part.edits) part.bytes += encode(edit).size();
  edits_ += part.edits.size();
  bytes_ += part.bytes;
  const auto is_nearer = [](const Part& a, const Part& b) { return a.distance < b.distance; };
  parts_.push_back(std::move(part));
  std::push_heap(parts_.begin(), parts_.end(), is_nearer);
  while (edits_ > kRestorePreviewEditsMax || bytes_ > kRestorePreviewBytesMax) {
    std::pop_heap(parts_.begin(), parts_.end(), is_nearer);
    edits_ -= parts_.back().edits.size();
    bytes_ -= parts_.back().bytes;
    parts_.pop_back();
    is_cut_ = true;
  }
}

void PreviewEdits::take(RestorePreview& out) {
  std::sort(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.at < b.at;
  });
  out.is_cut = is_cut_;
  for (Part& part : parts_)
    out.edits.insert(out.edits.end(), std::make_move_iterator(part.edits.begin()),
                     std::make_move_iterator(part.edits.end()));
  parts_.clear();
}

}  // namespace runstone
