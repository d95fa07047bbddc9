#include "client/replica/tracked_chunk.hpp"

#include <algorithm>
#include <utility>

#include "common/edits/descriptor/edit_memory.hpp"

namespace runstone {

void TrackedChunk::add_pending(ClientSequence seq, const EditDescriptor& edit) {
  const auto place =
      std::lower_bound(pending.begin(), pending.end(), seq,
                       [](const PendingEdit& p, ClientSequence s) { return p.seq < s; });
  if (place == pending.end() || place->seq != seq) pending.insert(place, {seq, edit, 0, false});
}

bool TrackedChunk::drop_pending(ClientSequence seq) {
  return std::erase_if(pending, [seq](const PendingEdit& p) { return p.seq == seq; }) != 0;
}

void TrackedChunk::confirm_pending(ClientSequence seq, Sequence at) {
  for (PendingEdit& edit : pending) {
    if (edit.seq == seq) edit.confirmed_at = at;
  }
}

void TrackedChunk::leave_to_snapshot(ClientSequence seq) {
  for (PendingEdit& edit : pending) {
    if (edit.seq == seq) edit.until_snapshot = true;
  }
}

std::size_t TrackedChunk::drop_answered(Sequence seq) {
  return std::erase_if(pending, [seq](const PendingEdit& p) {
    return p.until_snapshot || (p.confirmed_at != 0 && p.confirmed_at <= seq);
  });
}

std::size_t TrackedChunk::span_count(std::span<const InboxEdit> entries) {
  std::size_t count = 0;
  for (const InboxEdit& entry : entries) count += entry.patch ? entry.patch->spans.size() : 0;
  return count;
}

TrackedChunk::ReadyEdits TrackedChunk::take_ready_edits() {
  ReadyEdits out;
  out.version = confirmed_->version;
  std::size_t taken = 0;
  for (; taken < inbox.size(); ++taken) {
    const InboxEdit& next = inbox[taken];
    const bool is_repeated = next.is_repeatable() && next.previous == out.version.seq;
    const bool is_contained = next.version.seq <= out.version.seq && !is_repeated;
    if (!is_contained && next.previous != out.version.seq) break;
    if (next.info && next.info->is_local) drop_pending(next.info->op.seq);
    if (next.info) (is_contained ? out.contained : out.applied).push_back(next.info);
    if (is_contained) continue;
    if (next.has_edit) out.stack.push_back(next.info->edit);
    if (next.patch) out.patches.push_back({out.stack.size(), next.patch});
    if (!is_repeated) {
      out.version = next.version;
      repeatable.clear();
      continue;
    }
    cached.reset();  // the cache has this version without the patch
    if (repeatable.size() < kRepeatedPatchesMax &&
        span_count(repeatable) + span_count({&next, 1}) <= kPatchSpansMax)
      repeatable.push_back(next);
  }
  inbox.erase(inbox.begin(), inbox.begin() + static_cast<std::ptrdiff_t>(taken));
  return out;
}

void TrackedChunk::repeat_patches(const Version& version) {
  std::vector<InboxEdit> again = std::exchange(repeatable, {});
  std::erase_if(again, [&](const InboxEdit& patch) { return patch.version != version; });
  inbox.insert(inbox.begin(), again.begin(), again.end());
}

ShownPtr TrackedChunk::predicted(ApplyScratch& scratch) const {
  if (pending.empty()) return {confirmed_, &confirmed_->voxels};
  std::vector<EditDescriptor> stack;
  stack.reserve(pending.size());
  for (const PendingEdit& local : pending) stack.push_back(local.edit);
  auto next = std::make_shared<RunChunk>(confirmed_->voxels);
  Digest unused;
  apply_stack(*next, unused, origin(*next), stack, scratch);
  return next;
}

std::size_t TrackedChunk::bytes() const {
  std::size_t bytes = sizeof(TrackedChunk);
  if (confirmed_) bytes += sizeof(Chunk) + confirmed_->voxels.runs.byte_capacity();
  const bool is_shared = confirmed_ && shown.get() == &confirmed_->voxels;
  if (shown && !is_shared) bytes += sizeof(RunChunk) + shown->runs.byte_capacity();
  for (const PendingEdit& local : pending) bytes += sizeof(PendingEdit) + memory_bytes(local.edit);
  for (const std::vector<InboxEdit>* entries : {&inbox, &repeatable}) {
    for (const InboxEdit& entry : *entries) {
      bytes += sizeof(InboxEdit);
      if (entry.info) bytes += sizeof(OrderedInfo) + memory_bytes(entry.info->edit);
      if (entry.patch)
        bytes += sizeof(VeilPatch) + entry.patch->spans.capacity() * sizeof(VeilSpan);
    }
  }
  return bytes;
}

VoxelPos TrackedChunk::origin(const RunChunk& voxels) const {
  return origin_of(key.at, static_cast<std::int32_t>(voxels.extent.x));
}

}  // namespace runstone
