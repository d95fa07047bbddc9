#include "client/replica/tracked_chunk.hpp"

#include <algorithm>

namespace runstone {

void TrackedChunk::add_pending(ClientSequence seq, const EditDescriptor& edit) {
  const auto place = std::lower_bound(pending.begin(), pending.end(), seq,
                                      [](const Pending& p, ClientSequence s) { return p.seq < s; });
  if (place == pending.end() || place->seq != seq) pending.insert(place, {seq, edit, 0, false});
}

bool TrackedChunk::drop_pending(ClientSequence seq) {
  return std::erase_if(pending, [seq](const Pending& p) { return p.seq == seq; }) != 0;
}

std::size_t TrackedChunk::settle_pending(Sequence seq) {
  return std::erase_if(pending, [seq](const Pending& p) {
    return p.until_snapshot || (p.decided_at != 0 && p.decided_at <= seq);
  });
}

TrackedChunk::InOrder TrackedChunk::take_in_order() {
  InOrder out;
  out.version = confirmed->version;
  std::size_t taken = 0;
  for (; taken < inbox.size(); ++taken) {
    const Inbound& inbound = inbox[taken];
    const bool is_contained = inbound.info->version.seq <= out.version.seq;
    if (!is_contained && inbound.previous != out.version.seq) break;
    if (inbound.info->own) drop_pending(inbound.info->op.seq);
    (is_contained ? out.contained : out.applied).push_back(inbound.info);
    if (is_contained) continue;
    out.stack.push_back(inbound.info->edit);
    out.version = inbound.info->version;
  }
  inbox.erase(inbox.begin(), inbox.begin() + static_cast<std::ptrdiff_t>(taken));
  return out;
}

ShownPtr TrackedChunk::predicted(VoxelPos origin, ApplyScratch& scratch) const {
  if (pending.empty()) return {confirmed, &confirmed->voxels};
  std::vector<EditDescriptor> stack;
  stack.reserve(pending.size());
  for (const Pending& own : pending) stack.push_back(own.edit);
  auto next = std::make_shared<RunChunk>(confirmed->voxels);
  Digest unused;
  apply_stack(*next, unused, origin, stack, scratch);
  return next;
}

}  // namespace runstone
