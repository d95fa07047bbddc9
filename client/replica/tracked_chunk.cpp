#include "client/replica/tracked_chunk.hpp"

#include <algorithm>

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

TrackedChunk::ReadyEdits TrackedChunk::take_ready_edits() {
  ReadyEdits out;
  out.version = confirmed_->version;
  std::size_t taken = 0;
  for (; taken < inbox.size(); ++taken) {
    const InboxEdit& next = inbox[taken];
    const bool is_contained = next.info->version.seq <= out.version.seq;
    if (!is_contained && next.previous != out.version.seq) break;
    if (next.info->is_local) drop_pending(next.info->op.seq);
    (is_contained ? out.contained : out.applied).push_back(next.info);
    if (is_contained) continue;
    out.stack.push_back(next.info->edit);
    out.version = next.info->version;
  }
  inbox.erase(inbox.begin(), inbox.begin() + static_cast<std::ptrdiff_t>(taken));
  return out;
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
  for (const InboxEdit& held_back : inbox)
    bytes += sizeof(InboxEdit) + sizeof(OrderedInfo) + memory_bytes(held_back.info->edit);
  return bytes;
}

VoxelPos TrackedChunk::origin(const RunChunk& voxels) const {
  return origin_of(key.at, static_cast<std::int32_t>(voxels.extent.x));
}

}  // namespace runstone
