#include "server/world/order/edit_queue.hpp"

#include <algorithm>
#include <optional>
#include <variant>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/descriptor/edit_memory.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

// The work of a commit. One that holds a single edit may have more. With kWorkMax, the slowest
// commit takes a few milliseconds.
constexpr std::size_t kWorkMax = 128 * 1024;
constexpr std::size_t kEditWork = 128;     // the fields of OrderedEdit without the descriptor
constexpr std::size_t kChunkWork = 64;     // at least 10, a varint of OrderedEdit::previous
constexpr std::size_t kClipboardWork = 2;  // for a byte, at least 1
// An edit that no commit message has. So many as a commit may hold are one commit.
constexpr std::size_t kUnsentWork = kWorkMax / kCommitEditsMax;
static_assert(kWorkMax < kServerEditBytesMax / 2 && kEditWork +
                                                            kClipboardWork * kDescriptorBytesMax +
                                                            kChunkWork * kTouchedChunksMax <
                                                        kServerEditBytesMax / 2,
              "every commit fits its message");

std::tuple<AuthorId, ClientInstance, bool> client_of(const OperationId& op, Cause cause) {
  return {op.author, op.instance, cause == Cause::player};
}

std::size_t memory_of(const EditOffer& offer) {
  return sizeof(EditOffer) + memory_bytes(offer.edit);
}

}  // namespace

std::size_t edit_work(const EditDescriptor& edit, std::int32_t chunk_edge) {
  // No commit message has them, because no session sees them as edits.
  if (changes_materials(edit) || given_texture_of(edit) != nullptr) return kUnsentWork;
  const auto* paste = std::get_if<Paste>(&edit.shape);
  const std::size_t descriptor = paste == nullptr
                                     ? descriptor_bytes_max(kind_of(edit))
                                     : 64 + kClipboardWork * paste->clipboard->byte_size();
  const std::size_t chunks =
      std::min<std::size_t>(touched_chunks_bound(edit, chunk_edge), kTouchedChunksMax);
  return kEditWork + descriptor + kChunkWork * chunks;
}

bool EditQueue::has_room_for(const EditDescriptor& edit, AuthorId author) const {
  return large_work_ < kWaitingWorkMax ||
         !waits_for_room(edit_work(edit, chunk_edge_), Cause::player) ||
         (large_work_ < kFirstWaitingWorkMax && !has_of(author));
}

void EditQueue::push(const EditOffer& offer) {
  auto& lane = lanes_[client_of(offer.op, offer.cause)];
  lane.push_back({offer, edit_work(offer.edit, chunk_edge_)});
  if (lane.size() == 1 && lane.front().is_large()) ++large_fronts_;
  if (lane.back().is_large()) large_work_ += lane.back().work;
  bytes_ += memory_of(offer);
  ++size_;
}

bool EditQueue::has(const OperationId& op) const {
  const auto lane = lanes_.find(client_of(op, Cause::player));
  if (lane == lanes_.end()) return false;
  const auto seq_of = [](const Waiting& waiting) { return waiting.offer.op.seq; };
  const auto found = std::ranges::lower_bound(lane->second, op.seq, {}, seq_of);
  return found != lane->second.end() && seq_of(*found) == op.seq;
}

std::vector<OperationId> EditQueue::newest_of(AuthorId author) const {
  std::vector<OperationId> out;
  for (auto lane = lanes_.lower_bound(Client{author, 0, false});
       lane != lanes_.end() && std::get<AuthorId>(lane->first) == author; ++lane) {
    if (std::get<bool>(lane->first)) out.push_back(lane->second.back().offer.op);
  }
  return out;
}

bool EditQueue::has_of(AuthorId author) const {
  const auto lane = lanes_.lower_bound(Client{author, 0, false});
  return lane != lanes_.end() && std::get<AuthorId>(lane->first) == author;
}

EditQueue::Lanes::iterator EditQueue::pop(Lanes::iterator lane) {
  std::deque<Waiting>& edits = lane->second;
  if (edits.front().is_large()) {
    --large_fronts_;
    large_work_ -= edits.front().work;
  }
  edits.pop_front();
  --size_;
  if (edits.empty()) return lanes_.erase(lane);
  if (edits.front().is_large()) ++large_fronts_;
  return std::next(lane);
}

std::vector<EditOffer> EditQueue::take(std::uint64_t large_room) {
  std::vector<EditOffer> out;
  std::size_t work = 0;
  std::optional<Client> too_costly, without_room;  // the first lanes that were skipped
  auto lane = lanes_.lower_bound(turn_);
  for (bool has_taken = true; has_taken;) {
    has_taken = false;
    for (std::size_t left = lanes_.size(); left > 0 && out.size() < kCommitEditsMax; --left) {
      if (lane == lanes_.end()) lane = lanes_.begin();
      Waiting& next = lane->second.front();
      const bool is_large = next.is_large();
      const bool has_room = !is_large || large_room > 0;
      if (!has_room || (!out.empty() && work + next.work > kWorkMax)) {
        std::optional<Client>& skipped = has_room ? too_costly : without_room;
        if (!skipped) skipped = lane->first;
        ++lane;
        continue;
      }
      has_taken = true;
      work += next.work;
      if (is_large) large_room -= std::min<std::uint64_t>(large_room, next.work);
      bytes_ -= memory_of(next.offer);
      out.push_back(std::move(next.offer));
      lane = pop(lane);
    }
  }
  if (too_costly) {
    turn_ = *too_costly;
  } else if (out.size() < kCommitEditsMax && without_room) {
    turn_ = *without_room;
  } else {
    turn_ = lane == lanes_.end() ? Client{} : lane->first;
  }
  return out;
}

}  // namespace runstone
